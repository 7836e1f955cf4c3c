#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "output/summary.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

Summary example() {
  Summary summary;
  summary.status = RunStatus::interrupted;
  summary.case_name = "hole \"A\"";
  summary.version = "1.2.3";
  summary.instruction_set = "avx2";
  summary.metrics = {{"reaction_x", {210352.0 / 3, "N"}}, {"branches", {2, ""}}};
  summary.states = {{1.1, {{"reaction_x", {1e-300, "N"}}}}, {1.5, {}}};
  summary.energy = {0.1, 1.0 / 3, 0, 0.02, 0.03, 0.4, 1e-7};
  summary.timing = {12.5, 8, 2400, 40000, 1120000, 3.1e9};
  summary.memory_peak_bytes = std::int64_t{5} << 32;
  return summary;
}

TEST(Summary, HasTheKeysThatAreDocumented) {
  const Scratch scratch;
  write_summary(scratch / "summary.json", example());
  const auto object = nlohmann::json::parse(read_text(scratch / "summary.json"));
  EXPECT_EQ(object["status"], "interrupted");
  EXPECT_EQ(object["case"], "hole \"A\"");
  EXPECT_EQ(object["version"], "1.2.3");
  EXPECT_EQ(object["instruction_set"], "avx2");
  EXPECT_EQ(object["metrics"]["reaction_x"]["value"], 210352.0 / 3);
  EXPECT_EQ(object["metrics"]["reaction_x"]["unit"], "N");
  EXPECT_EQ(object["states"][0]["stretch"], 1.1);
  EXPECT_EQ(object["states"][0]["metrics"]["reaction_x"]["value"], 1e-300);
  EXPECT_TRUE(object["states"][1]["metrics"].is_object());
  EXPECT_EQ(object["energy"]["damped"], 0.02);
  EXPECT_EQ(object["energy"]["held"], 0.03);
  EXPECT_EQ(object["energy"]["external_work"], 0.4);
  EXPECT_EQ(object["energy"]["balance_error"], 1e-7);
  EXPECT_EQ(object["timing"]["wall_s"], 12.5);
  EXPECT_EQ(object["timing"]["iterations"], 2400);
  EXPECT_EQ(object["timing"]["bond_evaluations_per_second"], 3.1e9);
  EXPECT_EQ(object["memory_peak_bytes"], std::int64_t{5} << 32);
}

TEST(Summary, RoundTrips) {
  const Scratch scratch;
  for (const Parameter parameter : {Parameter::stretch, Parameter::time, Parameter::cycle}) {
    for (const RunStatus status : {RunStatus::finished, RunStatus::failed, RunStatus::interrupted}) {
      Summary summary = example();
      summary.parameter = parameter;
      summary.status = status;
      write_summary(scratch / "a.json", summary);
      const Summary back = read_summary(scratch / "a.json");
      EXPECT_EQ(back.status, status);
      EXPECT_EQ(back.parameter, parameter);
      EXPECT_EQ(back.states[0].value, 1.1);
      EXPECT_EQ(back.states[0].metrics.at("reaction_x").value, 1e-300);
      EXPECT_EQ(back.metrics.at("branches").unit, "");
      EXPECT_EQ(back.energy.strain, 1.0 / 3);
      EXPECT_EQ(back.timing.points, 40000);
      EXPECT_EQ(back.timing.iterations, 2400);
      write_summary(scratch / "b.json", back);
      EXPECT_EQ(read_text(scratch / "a.json"), read_text(scratch / "b.json"));
    }
  }
}

TEST(Summary, WhatIsNotFiniteIsNull) {
  const Scratch scratch;
  Summary summary;  // energies are NaN until known
  summary.metrics["a"] = {std::numeric_limits<double>::quiet_NaN(), "m"};
  summary.states = {{1, {{"b", {-std::numeric_limits<double>::infinity(), "m"}}}}};
  summary.timing.bond_evaluations_per_second = std::numeric_limits<double>::infinity();
  write_summary(scratch / "a.json", summary);
  const auto object = nlohmann::json::parse(read_text(scratch / "a.json"));
  EXPECT_TRUE(object["metrics"]["a"]["value"].is_null());
  EXPECT_TRUE(object["states"][0]["metrics"]["b"]["value"].is_null());
  EXPECT_TRUE(object["energy"]["kinetic"].is_null());
  EXPECT_TRUE(object["timing"]["bond_evaluations_per_second"].is_null());
  EXPECT_FALSE(object["timing"].contains("iterations"));
  const Summary back = read_summary(scratch / "a.json");
  EXPECT_TRUE(std::isnan(back.metrics.at("a").value));
  EXPECT_TRUE(std::isnan(back.energy.balance_error));
  EXPECT_FALSE(back.timing.iterations);
}

TEST(Summary, NamesThatAreNoUtf8DoNotStopARun) {
  const Scratch scratch;
  Summary summary;
  summary.case_name = "caf\xE9";
  write_summary(scratch / "a.json", summary);
  EXPECT_EQ(read_summary(scratch / "a.json").case_name, "caf\xEF\xBF\xBD");
}

TEST(Summary, RefusesDamagedFiles) {
  const Scratch scratch;
  const auto refused = [&](const std::string& text) {
    write_text(scratch / "a.json", text);
    return message_of<InputError>([&] { read_summary(scratch / "a.json"); });
  };
  write_summary(scratch / "good.json", example());
  const std::string good = read_text(scratch / "good.json");
  EXPECT_NE(refused(good.substr(0, good.size() / 2)).find("a.json"), std::string::npos);
  EXPECT_NE(refused("{}").find("status"), std::string::npos);
  std::string other = good;
  other.replace(other.find("interrupted"), 11, "sleeping");
  EXPECT_NE(refused(other).find("sleeping"), std::string::npos);
  EXPECT_NE(message_of<InputError>([&] { read_summary(scratch / "no.json"); }).find("no such file"),
            std::string::npos);
}

TEST(Summary, KnowsThePeakOfMemory) {
  const std::int64_t before = peak_memory_bytes();
  const std::vector<char> block(std::size_t{256} << 20, 'x');
  EXPECT_GE(peak_memory_bytes(), (std::int64_t{256} << 20));
  EXPECT_GE(peak_memory_bytes(), before);
  EXPECT_EQ(block.back(), 'x');
}

}  // namespace
}  // namespace riven
