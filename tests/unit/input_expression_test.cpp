#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "input/formula.hpp"

namespace riven {
namespace {

const Origin origin{"load.1.displacement", {"case.toml", 7, 16}, 17};
const Symbols symbols{0.005, 0.015, {"x", "y", "z", "t", "stretch"}};
constexpr Dimension rate{.second = -1};

double value(const std::string& text, const Dimension& d,
             const Variables& at = {{0.1, -0.2, 0.3}, 0.25, 1.5}) {
  return parse_formula(text, d, symbols, origin)(at);
}

std::string error(const std::string& text, const Dimension& d) {
  try {
    parse_formula(text, d, symbols, origin);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

std::string condition_error(const std::string& text) {
  try {
    parse_condition(text, symbols, origin);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Formula, NumbersWithUnitsStandAnywhere) {
  EXPECT_DOUBLE_EQ(value("20 mm - dx", dimension::length), 0.015);
  EXPECT_DOUBLE_EQ(value("3 dx", dimension::length), 0.015);
  EXPECT_DOUBLE_EQ(value("1 horizon", dimension::length), 0.015);
  EXPECT_DOUBLE_EQ(value("0.5 m / 100", dimension::length), 0.005);
  EXPECT_DOUBLE_EQ(value("100 MPa/s * t", dimension::pressure), 25e6);
  EXPECT_DOUBLE_EQ(value("0.15 /s", rate), 0.15);
  EXPECT_DOUBLE_EQ(value("0.15/s", rate), 0.15);
  EXPECT_DOUBLE_EQ(value("(stretch - 1)*x", dimension::length), 0.05);
  EXPECT_DOUBLE_EQ(value("-(5 mm)^2", dimension::area), -25e-6);
  EXPECT_DOUBLE_EQ(value("2 m^2", dimension::area), 2);
  EXPECT_DOUBLE_EQ(value("sqrt(x^2 + y^2)", dimension::length), std::hypot(0.1, 0.2));
  EXPECT_DOUBLE_EQ(value("sin(90 deg) * 1 mm", dimension::length), 1e-3);
  EXPECT_DOUBLE_EQ(value("2 MPa * (1 - cos(2*pi*10*t))", dimension::pressure),
                   2e6 * (1 - std::cos(20 * std::numbers::pi * 0.25)));
  EXPECT_DOUBLE_EQ(value("sin(20*x)*5 mm", dimension::length), 5e-3 * std::sin(2.0));
  EXPECT_DOUBLE_EQ(value("0.1 m/s * t + 1e-3 /s * t * x", dimension::length), 0.025 + 0.25e-3 * 0.1);
  EXPECT_DOUBLE_EQ(value("1 MPa * sign(y)", dimension::pressure), -1e6);
  EXPECT_DOUBLE_EQ(value("50 %", dimension::none), 0.5);
  EXPECT_DOUBLE_EQ(value("abs (y)", dimension::length), 0.2);
  EXPECT_DOUBLE_EQ(value("0", dimension::pressure), 0);
  EXPECT_DOUBLE_EQ(value("t < 1 ms ? 0 : 2 MPa", dimension::pressure), 2e6);
}

TEST(Formula, TheUnitOfANumberDoesNotChangeTheValue) {
  for (const double number : {1.0, 0.25, 3.7, 1e-3, 123456.0}) {
    const auto same = [&](const char* a, const char* b, double factor, const Dimension& d) {
      EXPECT_NEAR(
          value(std::to_string(number) + " " + a, d) / value(std::to_string(number * factor) + " " + b, d), 1,
          1e-5);
    };
    same("m", "mm", 1000, dimension::length);
    same("MPa", "N/mm^2", 1, dimension::pressure);
    same("g/cm^3", "kg/m^3", 1000, dimension::density);
    same("min", "s", 60, dimension::time);
  }
}

TEST(Formula, DimensionsThatDoNotFitAreRefused) {
  EXPECT_NE(error("2 MPa + 3 mm", dimension::pressure).find("do not fit together"), std::string::npos);
  EXPECT_NE(error("1 GPa + 1 nm", dimension::pressure).find("do not fit together"), std::string::npos);
  EXPECT_NE(error("1e6 * sign(y)", dimension::pressure).find("has no unit"), std::string::npos);
  EXPECT_NE(
      error("3 mm", dimension::pressure).find("is a length (m); expected a pressure, such as \"10 MPa\""),
      std::string::npos);
  EXPECT_NE(error("2 mm * 3 mm", dimension::length).find("is an area"), std::string::npos);
  EXPECT_NE(error("5", dimension::length).find("5 has no unit; write \"5 mm\" (a length)"),
            std::string::npos);
  EXPECT_NE(error("0.1*x", dimension::pressure).find("is a length"), std::string::npos);
  EXPECT_NE(error("x*sin(20*x)", dimension::length).find("do not fit"), std::string::npos);
  EXPECT_NE(error("3 mm", dimension::none).find("expected a number"), std::string::npos);
  EXPECT_EQ(error("x*sin(20 /m *x)", dimension::length), "accepted");
}

TEST(Formula, ErrorsPointIntoTheText) {
  // The text starts in column 17.
  EXPECT_EQ(error("2 mm * strech", dimension::length).substr(0, 41),
            "case.toml:7:24: load.1.displacement: \"2 m");
  EXPECT_NE(error("2 mm * strech", dimension::length).find("did you mean \"stretch\"?"), std::string::npos);
  EXPECT_EQ(error("1 µm * strech", dimension::length).substr(0, 15), "case.toml:7:24:");
  EXPECT_EQ(error("2 mmm", dimension::length).substr(0, 15), "case.toml:7:19:");
  EXPECT_NE(error("2 mmm", dimension::length).find("unknown unit \"mmm\""), std::string::npos);
  EXPECT_NE(error("2 mmm", dimension::length).find("did you mean \"mm\"?"), std::string::npos);
  EXPECT_EQ(error("x = 3 mm", dimension::length).substr(0, 15), "case.toml:7:19:");
  EXPECT_EQ(
      error("20 1/s", rate),
      "case.toml:7:20: load.1.displacement: \"20 1/s\": a unit does not begin with a number; write \"20 "
      "/s\" or \"20 s^-1\"");
  EXPECT_NE(error("2e3 1/s^2 * x", dimension::length).find("write \"2e3 /s^2\""), std::string::npos);
  EXPECT_NE(error("2 3", dimension::none).find("two numbers stand side by side"), std::string::npos);
  EXPECT_NE(error("2 1/min(x, y)", dimension::none).find("two numbers stand side by side"),
            std::string::npos);
  EXPECT_NE(error("2 1/s^0.5", rate).find("must be a whole number"), std::string::npos);
  EXPECT_EQ(error("20 s^-1", rate), "accepted");
  EXPECT_NE(error("20", rate).find("write \"20 /s\" (a rate)"), std::string::npos) << error("20", rate);
}

TEST(Formula, UnitsThatMessagesProposeAreAccepted) {
  for (const Dimension& d : {rate, Dimension{.second = -2}, Dimension{.metre = -3}, Dimension{.kelvin = -1},
                             Dimension{.metre = 1, .second = -3, .kilogram = 2}, dimension::density})
    EXPECT_EQ(error("10 " + usual_unit(d), d), "accepted") << usual_unit(d);
}

TEST(Formula, WhatIsNoFormulaIsRefused) {
  for (const char* text :
       {"",         "  ",     "(2 mm",      "2 mm)",   "2 mm,3 mm", "2 x",    "2 mm 3 mm",
        "x +",      "mm",     "s^0.5",      "5 m^0.5", "1/0",       "1 mm/0", "sqrt(-1)*1 mm",
        "1e999 mm", "foo(x)", "\"x\"",      "3 dx^2",  "x = 1 mm",  "2 d",    "7 h",
        "sin x",    "#",      "2 mm; 3 mm", "y and x"})
    EXPECT_NE(error(text, dimension::length), "accepted") << text;
}

TEST(Formula, NamesAreKnownOnlyWhereTheyAreDefined) {
  const Symbols none;
  EXPECT_THROW(parse_quantity("3 dx", dimension::length, none, origin), InputError);
  EXPECT_THROW(parse_quantity("horizon", dimension::length, none, origin), InputError);
  EXPECT_THROW(parse_quantity("x", dimension::length, none, origin), InputError);
  const Symbols in_time{0.005, 0.015, {"x", "y", "z", "t"}};
  EXPECT_THROW(parse_formula("(stretch - 1)*x", dimension::length, in_time, origin), InputError);
}

TEST(Formula, AnyQuantityFindsItsDimension) {
  const Quantity toughness = parse_quantity("3.8 J/m^2", symbols, origin);
  EXPECT_DOUBLE_EQ(toughness.si, 3.8);
  EXPECT_EQ(toughness.dimension, (Dimension{.second = -2, .kilogram = 1}));
  EXPECT_EQ(parse_quantity("2 mm * 3 MPa", symbols, origin).dimension,
            (Dimension{.second = -2, .kilogram = 1}));
  EXPECT_THROW(parse_quantity("1 mm + 1 s", symbols, origin), InputError);
  EXPECT_THROW(parse_quantity("sqrt(1 mm)", symbols, origin), InputError);
}

TEST(Condition, IsTrueOrFalse) {
  const Expression ends = parse_condition("abs(y) > 20 mm - dx", symbols, origin);
  EXPECT_EQ(ends({{0, 0.016, 0}, 0, 1}), 1);
  EXPECT_EQ(ends({{0, 0.014, 0}, 0, 1}), 0);
  EXPECT_EQ(condition_error("x > 0 && y < 0.1*x"), "accepted");
  EXPECT_EQ(condition_error("sqrt(x^2 + y^2) <= 80 mm || x == 0"), "accepted");
}

TEST(Condition, RefusesNumbersAndForgottenUnits) {
  EXPECT_NE(condition_error("x").find("true or false"), std::string::npos);
  EXPECT_NE(condition_error("x > 0.1").find("do not fit together"), std::string::npos);
  EXPECT_NE(condition_error("abs(y) > 20").find("do not fit together"), std::string::npos);
  EXPECT_NE(condition_error("abs(y) > 2 MPa").find("do not fit together"), std::string::npos);
  EXPECT_NE(condition_error("y > x^2").find("do not fit together"), std::string::npos);
}

TEST(Expression, KnowsWhatItDependsOn) {
  const Expression e = parse_formula("(stretch - 1)*x", dimension::length, symbols, origin);
  EXPECT_TRUE(e.depends_on("x"));
  EXPECT_TRUE(e.depends_on("stretch"));
  EXPECT_FALSE(e.depends_on("y"));
  EXPECT_EQ(e.written(), "(stretch - 1)*x");
  EXPECT_EQ(e.location().line, 7);
}

TEST(Expression, RefusesWhatDoesNotParse) {
  EXPECT_THROW(Expression("2 +", "2 +", {"case.toml", 1, 1}), InputError);
}

}  // namespace
}  // namespace riven
