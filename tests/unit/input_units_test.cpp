#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "base/nearest_name.hpp"
#include "input/units.hpp"

namespace riven {
namespace {

double in_si(double number, const std::string& unit) {
  const auto match = match_unit(unit, 0);
  if (!match || match->length != unit.size()) return std::nan("");
  return to_si(number, match->unit);
}

TEST(Units, EveryNameIsKnownToUdunits) {
  for (const std::string& name : unit_names()) {
    EXPECT_TRUE(is_unit(name)) << name;
    EXPECT_GT(in_si(1, name), 0) << name;
  }
}

TEST(Units, ValuesAreThoseOfTheDefinitions) {
  EXPECT_EQ(in_si(5, "mm"), 0.005);
  EXPECT_EQ(in_si(43, "us"), 43e-6);
  EXPECT_EQ(in_si(43, "µs"), 43e-6);
  EXPECT_EQ(in_si(3, "min"), 180);
  EXPECT_EQ(in_si(2, "g"), 0.002);
  EXPECT_EQ(in_si(7, "mg"), 7e-6);
  EXPECT_EQ(in_si(2, "MPa/s"), 2e6);
  EXPECT_EQ(in_si(50, "%"), 0.5);
  EXPECT_NEAR(in_si(180, "deg"), 3.14159265358979, 1e-13);
  EXPECT_EQ(in_si(1, "rad"), 1);
  EXPECT_EQ(in_si(1, "kg/m^3"), 1);
  EXPECT_EQ(in_si(1, "kJ / m^2"), 1000);
  EXPECT_EQ(in_si(2, "/ms"), 2000);
  EXPECT_NEAR(in_si(1, "mm^-2"), 1e6, 1e-9);
  EXPECT_NEAR(in_si(1, "N*mm"), 1e-3, 1e-18);
}

TEST(Units, DimensionsFollowThePowers) {
  EXPECT_EQ(match_unit("MPa", 0)->unit.dimension, dimension::pressure);
  EXPECT_EQ(match_unit("N/m^2", 0)->unit.dimension, dimension::pressure);
  EXPECT_EQ(match_unit("J/m^3", 0)->unit.dimension, dimension::pressure);
  EXPECT_EQ(match_unit("g/cm^3", 0)->unit.dimension, dimension::density);
  EXPECT_EQ(match_unit("deg", 0)->unit.dimension, dimension::none);
  EXPECT_EQ(match_unit("K", 0)->unit.dimension, Dimension{.kelvin = 1});
}

TEST(Units, OnlyTheListIsAccepted) {
  // UDUNITS reads these: day, hour, inch, year, degree Celsius, ...
  for (const char* name : {"d", "h", "in", "yr", "degC", "psi", "mmm", "M", "PA", "u", "l", ""})
    EXPECT_FALSE(match_unit(name, 0)) << name;
}

TEST(Units, AUnitEndsWhereTheFormulaGoesOn) {
  EXPECT_EQ(match_unit("m / 100", 0)->length, 1U);
  EXPECT_EQ(match_unit("MPa/s * t", 0)->length, 5U);
  EXPECT_EQ(match_unit("mm*x", 0)->length, 2U);
  EXPECT_FALSE(match_unit("min(x, y)", 0));
  EXPECT_FALSE(match_unit("/min(x, y)", 0));
}

TEST(Units, PowersAreWhole) {
  EXPECT_THROW(match_unit("s^-0.6665", 0), std::invalid_argument);
  EXPECT_THROW(match_unit("m^x", 0), std::invalid_argument);
  EXPECT_THROW(match_unit("m^", 0), std::invalid_argument);
}

TEST(Units, TheSiUnitOfADimensionReadsBack) {
  for (int m = -3; m <= 3; ++m)
    for (int s = -3; s <= 3; ++s)
      for (int kg = -1; kg <= 1; ++kg) {
        const Dimension wanted{.metre = m, .second = s, .kilogram = kg};
        if (wanted == dimension::none) continue;
        const std::string unit = si_unit(wanted);
        const std::string text = unit.starts_with("1/") ? unit.substr(1) : unit;
        const auto match = match_unit(text, 0);
        ASSERT_TRUE(match) << unit;
        EXPECT_EQ(match->length, text.size()) << unit;
        EXPECT_EQ(match->unit.dimension, wanted) << unit;
        EXPECT_EQ(match->unit.factor, 1) << unit;
      }
}

TEST(NearestName, FindsTheTypo) {
  const std::vector<std::string> names{"stabilisation", "kind", "horizon", "spacing"};
  EXPECT_EQ(nearest_name("stabilization", names), "stabilisation");
  EXPECT_EQ(nearest_name("Horizon", names), "horizon");
  EXPECT_EQ(nearest_name("spaicng", names), "spacing");
  EXPECT_EQ(nearest_name("temperature", names), "");
  EXPECT_EQ(did_you_mean("knd", names), "; did you mean \"kind\"?");
  EXPECT_EQ(did_you_mean("zzz", names), "");
}

}  // namespace
}  // namespace riven
