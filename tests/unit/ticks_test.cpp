#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "report/ticks.hpp"

namespace riven {
namespace {

TEST(Ticks, AreTheUsualOnes) {
  EXPECT_EQ(ticks({0, 1}, 6), (std::vector<double>{0, 0.2, 0.4, 0.6, 0.8, 1}));
  EXPECT_EQ(ticks({-0.3, 0.3}, 7), (std::vector<double>{-0.3, -0.2, -0.1, 0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(ticks({190, 460}, 6), (std::vector<double>{200, 250, 300, 350, 400, 450}));
  EXPECT_EQ(ticks({3, 3}, 5), (std::vector<double>{3}));
  EXPECT_TRUE(ticks({}, 5).empty());
}

// What a tick is, checked without the search that finds them: multiples of 1, 2 or 5 times a power of ten,
// without gaps, inside, neither too few nor too many.
TEST(Ticks, OfAnyRange) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> power(-12, 12), part(-1, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const double width = std::pow(10, power(random)), low = 10 * width * part(random);
    const Range range{low, low + width};
    const int most = 2 + trial % 9;
    const std::vector<double> all = ticks(range, most);
    ASSERT_GE(all.size(), 2U);
    // Where only one multiple of 5 lies inside, up to five of 2 do.
    ASSERT_LE(all.size(), static_cast<std::size_t>(std::max(most, 5)));
    const double step = all[1] - all[0];
    const double digits = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
    EXPECT_LT(std::min({std::abs(digits - 1), std::abs(digits - 2), std::abs(digits - 5)}), 1e-6) << step;
    for (std::size_t n = 0; n < all.size(); ++n) {
      EXPECT_NEAR(all[n] / step, std::round(all[n] / step), 1e-6);
      EXPECT_GE(all[n], range.low - 1e-8 * width);
      EXPECT_LE(all[n], range.high + 1e-8 * width);
      EXPECT_NEAR(all[n], all[0] + static_cast<double>(n) * step, 1e-6 * step);
    }
    EXPECT_LT(all.front() - step, range.low);
    EXPECT_GT(all.back() + step, range.high);

    const std::vector<std::string> texts = tick_texts(all);
    EXPECT_EQ(std::set<std::string>(texts.begin(), texts.end()).size(), all.size());
    for (std::size_t n = 0; n < all.size(); ++n) EXPECT_NEAR(std::stod(texts[n]), all[n], 1e-3 * step);
  }
}

TEST(Ticks, ARangeWithoutStepsHasOne) {
  for (const Range& range : {Range{0, 0}, Range{0, 1e-320}, Range{0, 5e-324}, Range{1, 1 + 2.3e-16},
                             Range{-1e308, 1e308}, Range{1e300, 1e300 * (1 + 1e-15)}})
    EXPECT_EQ(ticks(range, 8), std::vector<double>{range.low});
}

TEST(Ticks, HaveTheDecimalsThatTheyNeed) {
  EXPECT_EQ(tick_texts({0, 0.5, 1}), (std::vector<std::string>{"0.0", "0.5", "1.0"}));
  EXPECT_EQ(tick_texts({-200, 0, 200}), (std::vector<std::string>{"-200", "0", "200"}));
  EXPECT_EQ(tick_texts({-0.02, -0.0, 0.02}), (std::vector<std::string>{"-0.02", "0.00", "0.02"}));
}

TEST(ReadableUnit, TakesThePrefixThatMakesNumbersShort) {
  struct Expected {
    std::string unit;
    double largest, factor;
    std::string readable;
  };
  for (const Expected& e : std::vector<Expected>{{"Pa", 2.5e6, 1e-6, "MPa"},
                                                 {"J/m^3", 1.3e9, 1e-9, "GJ/m³"},
                                                 {"m", 0.75, 1e3, "mm"},
                                                 {"m", 1.5, 1, "m"},
                                                 {"m", 3e-7, 1e9, "nm"},
                                                 {"m/s", 2e-5, 1e6, "µm/s"},
                                                 {"N", 999.9, 1, "N"},
                                                 {"N", 1000, 1e-3, "kN"},
                                                 {"kg/m^3", 2440, 1, "kg/m³"},
                                                 {"m^2", 2e-6, 1e6, "10⁻⁶ m²"},
                                                 {"1/s", 5e7, 1e-6, "10⁶ 1/s"},
                                                 {"", 0.4, 1, ""},
                                                 {"1", 0.4, 1, ""},
                                                 {"", 2e-5, 1e6, "10⁻⁶"},
                                                 {"", 0, 1, ""},
                                                 {"Pa", 0, 1, "Pa"},
                                                 {"Pa", std::nan(""), 1, "Pa"}}) {
    const ReadableUnit found = readable_unit(e.unit, e.largest);
    EXPECT_EQ(found.unit, e.readable) << e.unit << " " << e.largest;
    EXPECT_NEAR(found.factor / e.factor, 1, 1e-12) << e.unit << " " << e.largest;
  }
}

TEST(ReadableUnit, OneToAThousandAtAnySize) {
  for (double power = -11.9; power < 17; power += 0.1) {
    const double largest = std::pow(10, power), shown = largest * readable_unit("N", largest).factor;
    EXPECT_GE(shown, 1 - 1e-9) << largest;
    EXPECT_LT(shown, 1000) << largest;
  }
}

TEST(ReadableUnit, Texts) {
  EXPECT_EQ(readable(220.853, "N"), "220.9 N");
  EXPECT_EQ(readable(1.25e7, "Pa"), "12.5 MPa");
  EXPECT_EQ(readable(1.5, ""), "1.5");
  EXPECT_EQ(readable(2e-5, ""), "2e-05");
  EXPECT_EQ(readable_unit("J/m^3", 2e6).label("strain_energy_density"), "strain energy density [MJ/m³]");
  EXPECT_EQ(readable_unit("", 1).label("damage"), "damage");
  EXPECT_EQ(name_and_unit("force_x [N]"), (std::pair<std::string, std::string>("force_x", "N")));
  EXPECT_EQ(name_and_unit("stretch"), (std::pair<std::string, std::string>("stretch", "")));
}

TEST(Range, LeavesOutWhatIsNoNumber) {
  Range range;
  range.include(std::nan(""));
  range.include(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(range.empty());
  range.include(-3);
  range.include(2);
  EXPECT_EQ(range.low, -3);
  EXPECT_EQ(range.high, 2);
}

}  // namespace
}  // namespace riven
