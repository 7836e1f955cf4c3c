#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "verification/compare.hpp"

namespace riven {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string place(const Point& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p[0], p[1], p[2]);
}

}  // namespace

std::string table(const FieldDeviation& deviation) {
  std::string text = fmt::format("{:>12}  {:>11}  {:>11}  {:<28}  {:>6}  {:>8}  {:>7}\n", "state",
                                 "relative L2", "maximum (m)", "at (m)", "points", "excluded", "outside");
  for (const StateDeviation& state : deviation.states) {
    text += fmt::format("{:>12.6g}  {:>11.3e}  {:>11.3e}  {:<28}  {:>6}  {:>8}  {:>7}\n", state.value,
                        state.relative_l2, state.maximum, place(state.maximum_at), state.used, state.excluded,
                        state.outside);
  }
  for (const double value : deviation.missing)
    text += fmt::format("{:>12.6g}  the result lacks this state\n", value);
  if (!deviation.uncompared.empty()) {
    text += "not compared, for the reference lacks them: ";
    for (const double value : deviation.uncompared)
      text += fmt::format("{}{:.6g}", text.ends_with(": ") ? "" : ", ", value);
    text += '\n';
  }
  return text;
}

std::string table(const HistoryDeviation& deviation) {
  return fmt::format("{:>11}  {:>11}  {:>12}  {:>6}  {:>7}\n{:>11.3e}  {:>11.3e}  {:>12.6g}  {:>6}  {:>7}\n",
                     "relative L2", "maximum", "at", "rows", "outside", deviation.relative_l2,
                     deviation.maximum, deviation.maximum_at, deviation.used, deviation.outside);
}

Json to_json(const FieldDeviation& deviation) {
  Json object = {
      {"states", Json::array()}, {"missing", deviation.missing}, {"uncompared", deviation.uncompared}};
  for (const StateDeviation& state : deviation.states) {
    object["states"].push_back({{"value", state.value},
                                {"relative_l2", number(state.relative_l2)},
                                {"maximum", number(state.maximum)},
                                {"maximum_at", state.maximum_at},
                                {"used", state.used},
                                {"excluded", state.excluded},
                                {"outside", state.outside}});
  }
  return object;
}

Json to_json(const HistoryDeviation& deviation) {
  return {{"relative_l2", number(deviation.relative_l2)},
          {"maximum", number(deviation.maximum)},
          {"maximum_at", deviation.maximum_at},
          {"used", deviation.used},
          {"outside", deviation.outside}};
}

}  // namespace riven
