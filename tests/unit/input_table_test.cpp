#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "base/error.hpp"
#include "input/case_reader.hpp"
#include "input/formula.hpp"
#include "input/table_function.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::message_of;
using test::Scratch;
using test::write_text;

std::shared_ptr<const TableFunction> make(const std::string& text, bool hold = false,
                                          const std::string& name = "pull") {
  const Scratch scratch;
  write_text(scratch / "a.csv", text);
  return std::make_shared<const TableFunction>(read_table(name, scratch / "a.csv", "", "", hold));
}

std::string refusal(const std::string& text, const std::string& argument = "",
                    const std::string& value = "") {
  const Scratch scratch;
  write_text(scratch / "a.csv", text);
  return message_of<InputError>([&] { read_table("pull", scratch / "a.csv", argument, value, false); });
}

double at(const TableFunction& table, double argument) {
  std::size_t interval = 0;
  return table.value(argument, interval);
}

const std::string pull = "time [ms], displacement [mm]\n0,0\n1,1\n2,1.5\n4,2\n";

TEST(TableFunction, IsLinearBetweenItsPointsInSiUnits) {
  const auto table = make(pull);
  EXPECT_EQ(table->argument().dimension, dimension::time);
  EXPECT_EQ(table->value().dimension, dimension::length);
  EXPECT_EQ(at(*table, 0), 0);
  EXPECT_EQ(at(*table, 0.001), 0.001);  // a point itself is exact
  EXPECT_EQ(at(*table, 0.002), 0.0015);
  EXPECT_EQ(at(*table, 0.004), 0.002);
  EXPECT_DOUBLE_EQ(at(*table, 0.0015), 0.00125);
  EXPECT_DOUBLE_EQ(at(*table, 0.003), 0.00175);
  EXPECT_TRUE(std::isnan(at(*table, std::numeric_limits<double>::quiet_NaN())));
}

TEST(TableFunction, FindsTheSameWhereverItLooksFirst) {
  std::string text = "a,b\n";
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> x{-3}, y{0.5};
  for (int n = 0; n < 50; ++n) {
    x.push_back(x.back() + 0.01 + uniform(random));
    y.push_back(uniform(random));
  }
  for (std::size_t n = 0; n < x.size(); ++n) text += std::to_string(x[n]) + "," + std::to_string(y[n]) + "\n";
  const auto table = make(text);
  const auto& points = table->argument().values;
  std::size_t interval = 0;
  for (int n = 0; n < 1000; ++n) {
    const double argument = points.front() + uniform(random) * (points.back() - points.front());
    std::size_t k = 0;  // the naive search
    while (k + 2 < points.size() && argument >= points[k + 1]) ++k;
    const auto& values = table->value().values;
    const double part = (argument - points[k]) / (points[k + 1] - points[k]);
    EXPECT_EQ(table->value(argument, interval), values[k] + part * (values[k + 1] - values[k]));
  }
}

TEST(TableFunction, CoversItsRangeWithRoundingAndHoldsBeyondIt) {
  const auto table = make(pull);
  EXPECT_TRUE(table->covers(0));
  EXPECT_TRUE(table->covers(0.004 * (1 + 1e-12)));
  EXPECT_TRUE(table->covers(-1e-14));
  EXPECT_FALSE(table->covers(0.004 * (1 + 1e-6)));
  EXPECT_FALSE(table->covers(-1e-9));
  EXPECT_FALSE(table->covers(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ(at(*table, -1), 0);
  EXPECT_EQ(at(*table, 1), 0.002);
}

TEST(TableFunction, UnitsStandInTheColumnsNames) {
  const auto dimensions = [](const std::string& a, const std::string& b) {
    const auto table = make(a + "," + b + "\n1,2\n2,3\n");
    return std::pair{table->argument().dimension, table->value().dimension};
  };
  using D = Dimension;
  EXPECT_EQ(dimensions("t [s]", "p [MPa]"), (std::pair{dimension::time, dimension::pressure}));
  EXPECT_EQ(dimensions("stretch", "u[mm]"), (std::pair{dimension::none, dimension::length}));
  EXPECT_EQ(dimensions("a [-]", "b [1]"), (std::pair{dimension::none, dimension::none}));
  EXPECT_EQ(dimensions("a []", "b [%]"), (std::pair{dimension::none, dimension::none}));
  EXPECT_EQ(dimensions("rate [1/s]", "f [N/m]"),
            (std::pair{D{.second = -1}, D{.second = -2, .kilogram = 1}}));
  EXPECT_EQ(make("t [ms],v [%]\n1,50\n2,100\n")->value().values, (std::vector{0.5, 1.0}));
  EXPECT_EQ(without_unit("time [ms]"), "time");
  EXPECT_EQ(without_unit("time"), "time");
  EXPECT_EQ(without_unit("u[mm]"), "u");
}

TEST(TableFunction, ColumnsAreChosenByName) {
  const Scratch scratch;
  write_text(scratch / "a.csv", "step,time [s],u [mm],v [mm]\n1,0,0,5\n2,1,3,6\n");
  const TableFunction table = read_table("pull", scratch / "a.csv", "time", "v [mm]", false);
  EXPECT_EQ(table.argument().values, (std::vector{0.0, 1.0}));
  EXPECT_EQ(table.value().values, (std::vector{0.005, 0.006}));
}

TEST(TableFunction, RefusesWhatIsNoTable) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"t,u\n0,0\n1,one\n", "a.csv:3: column \"u\": expected a number, found \"one\""},
           {"t,u\n0,0\n1,nan\n", "a.csv:3: column \"u\": found nan; expected a finite number"},
           {"t,u\n0,0\ninf,1\n", "a.csv:3: column \"t\": found inf; expected a finite number"},
           {"t,u\n# note\n0,0\n", "a.csv:1: found one row below the column names; expected two rows"},
           {"t,u\n", "a.csv:1: found no row"},
           {"t\n0\n1\n", "a.csv:1: found one column, \"t\"; expected an argument and a value"},
           {"t;u\n0;0\n1;1\n", "a.csv:1: found cells separated by semicolons; expected commas between cells"},
           {"", "a.csv: expected a row of column names"},
           {"t,u\n0,0\n1,1\n1,2\n",
            "a.csv:4: column \"t\": 1 comes after 1; expected an argument that rises"},
           {"t,u\n0,0\n1,1\n0.5,2\n", "a.csv:4: column \"t\": 0.5 comes after 1"},
           {"t [sec],u\n0,0\n1,1\n", "a.csv:1: column \"t [sec]\": unknown unit \"sec\"; units are m, mm"},
           {"t [s],u [Mpa]\n0,0\n1,1\n", "did you mean \"MPa\"?"},
           {"t [s^0.5],u\n0,0\n1,1\n", "must be a whole number"}})
    EXPECT_NE(refusal(text).find(message), std::string::npos) << refusal(text);
  EXPECT_NE(refusal("time [s],u\n0,0\n1,1\n", "tme").find("there are: time [s], u; did you mean \"time\"?"),
            std::string::npos);
  EXPECT_NE(refusal("t,u\n0,0\n1,1\n", "u").find("is both argument and value"), std::string::npos);
}

const Origin origin{"load.1.displacement", {"case.toml", 7, 16}, 17};

Symbols symbols(const std::string& text = pull, bool hold = false) {
  return {0.005, 0.015, {"x", "y", "z", "t", "stretch"}, {make(text, hold)}};
}

double value(const std::string& text, const Variables& where, const Symbols& known = symbols(),
             const Dimension& d = dimension::length) {
  return parse_formula(text, d, known, origin)(where);
}

std::string error(const std::string& text, const Symbols& known = symbols(),
                  const Dimension& d = dimension::length) {
  return message_of<InputError>([&] { parse_formula(text, d, known, origin); });
}

TEST(TableInFormulas, IsAFunctionWithUnits) {
  const Variables then{{0.1, -0.2, 0.3}, 0.0015, 1.5};
  EXPECT_DOUBLE_EQ(value("pull(t)", then), 0.00125);
  EXPECT_DOUBLE_EQ(value("-2*pull(t)^2 / 1 m", then), -2 * 0.00125 * 0.00125);
  EXPECT_DOUBLE_EQ(value("pull(t) * x / 0.25 m", then), 0.00125 * 0.4);
  EXPECT_DOUBLE_EQ(value("pull(2*t + 1 ms) - pull (0.5 ms)", then), 0.002 - 0.0005);
  EXPECT_DOUBLE_EQ(value("pull(1 ms * stretch)", then), 0.00125);
  EXPECT_DOUBLE_EQ(value("pull(1 s * pull(t) / 1 m)", then), 0.001125);
  EXPECT_DOUBLE_EQ(value("1 m * sin(pull(t) / 1 mm)", then), std::sin(1.25));
  EXPECT_DOUBLE_EQ(parse_quantity("pull(2 ms)", dimension::length, symbols(), origin), 0.0015);
  EXPECT_EQ(parse_quantity("pull(2 ms) / 1 s", symbols(), origin).dimension,
            (Dimension{.metre = 1, .second = -1}));
  const Expression inside = parse_condition(
      "y < edge(x)", {.variables = {"x", "y"}, .tables = {make("x [m],y [m]\n0,0\n1,1\n", false, "edge")}},
      origin);
  EXPECT_EQ(inside({.position = {0.5, 0.4, 0}}), 1);
  EXPECT_EQ(inside({.position = {0.5, 0.6, 0}}), 0);
}

TEST(TableInFormulas, DimensionsAreCheckedWhateverThePointsAre) {
  const std::string zeros = "time [ms],displacement [mm]\n0,0\n1,0\n";
  for (const std::string& text : {pull, zeros}) {
    SCOPED_TRACE(text);
    EXPECT_NE(error("pull(x)", symbols(text)).find("do not fit together"), std::string::npos);
    EXPECT_NE(
        error("pull(x)", symbols(text))
            .find("the table pull takes a time (\"time [ms]\") and gives a length (\"displacement [mm]\")"),
        std::string::npos);
    EXPECT_NE(error("pull(2)", symbols(text)).find("do not fit together"), std::string::npos);
    EXPECT_NE(error("pull(stretch)", symbols(text)).find("do not fit together"), std::string::npos);
    EXPECT_NE(error("pull(1000 m)", symbols(text)).find("do not fit together"), std::string::npos);
    EXPECT_NE(error("pull(1e-6 MPa)", symbols(text)).find("do not fit together"), std::string::npos);
    EXPECT_NE(error("1 mm * pull(t)", symbols(text)).find("an area"), std::string::npos);
    EXPECT_NE(
        error("pull(t)", symbols(text), dimension::pressure).find("is a length (m); expected a pressure"),
        std::string::npos);
    EXPECT_NO_THROW(parse_formula("pull(1e6*t)", dimension::length, symbols(text), origin));
  }
  // The columns have no units: numbers.
  const Symbols numbers = symbols("time,displacement\n0,0\n1,0.5\n");
  EXPECT_NE(error("pull(t)", numbers).find("has no unit"), std::string::npos);
  EXPECT_NO_THROW(parse_formula("pull(t / 1 s) * 1 mm", dimension::length, numbers, origin));
}

TEST(TableInFormulas, BeyondTheEndsIsAnErrorOrHeld) {
  const Expression open = parse_formula("pull(t) + 0*x", dimension::length, symbols(), origin);
  EXPECT_NO_THROW(open({.t = 0.004}));
  const std::string message = message_of<InputError>([&] { open({.position = {0.1, 0, 0}, .t = 0.005}); });
  EXPECT_NE(
      message.find("case.toml:7:16: \"pull(t) + 0*x\": the table pull has no value at 0.005 s (at x = 0.1 m, "
                   "t = 0.005 s)"),
      std::string::npos)
      << message;
  EXPECT_NE(message.find("goes from 0 s to 0.004 s"), std::string::npos) << message;
  EXPECT_NO_THROW(open({.t = 0.003})) << "it must forget";
  // The branch that is not taken asks nothing.
  const Expression branch = parse_formula("t < 4 ms ? pull(t) : 2 mm", dimension::length, symbols(), origin);
  EXPECT_EQ(branch({.t = 1}), 0.002);
  const Expression held = parse_formula("pull(t)", dimension::length, symbols(pull, true), origin);
  EXPECT_EQ(held({.t = 1}), 0.002);
  EXPECT_EQ(held({.t = -1}), 0);
  EXPECT_THROW(static_cast<void>(parse_quantity("pull(1 s)", dimension::length, symbols(), origin)),
               InputError);
}

TEST(TableInFormulas, MistakesAreNamed) {
  EXPECT_NE(error("pul(t)").find("did you mean \"pull\"?"), std::string::npos);
  EXPECT_NE(error("pull * x").find("\"pull\" is a table; write its argument in brackets"), std::string::npos);
  EXPECT_NE(error("2 pull(t)").find("write \"2*pull\""), std::string::npos);
  EXPECT_NE(error("pull(t, x)").find("Too many parameters"), std::string::npos);
  EXPECT_NE(error("pull()").find("Too few parameters"), std::string::npos);
}

TEST(TableInFormulas, KnowsWhatNamesMean) {
  EXPECT_EQ(meaning_in_formulas("sin"), "a function");
  EXPECT_EQ(meaning_in_formulas("mm"), "a unit");
  EXPECT_EQ(meaning_in_formulas("stretch"), "a variable");
  EXPECT_EQ(meaning_in_formulas("dx"), "a length");
  EXPECT_EQ(meaning_in_formulas("pi"), "a number");
  EXPECT_EQ(meaning_in_formulas("pull"), "");
}

}  // namespace
}  // namespace riven
