#include "simulation/largest_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/snapshot.hpp"
#include "support/random.hpp"

namespace riven {
namespace {

using Row = std::vector<double>;

// Columns: 0 and 1 are measured; then the largest of 0, what 1 was there, when that was, the largest of the
// largest.
const std::vector<LargestColumn> kColumns = {{.column = 2, .of = 0, .gives = 0},
                                             {.column = 3, .of = 0, .gives = 1},
                                             {.column = 4, .of = 0, .gives = {}},
                                             {.column = 5, .of = 2, .gives = 2}};

LargestValues of_columns() {
  LargestValues largest;
  for (const LargestColumn& column : kColumns) largest.add(column);
  return largest;
}

TEST(LargestValues, AreThoseOfAllRowsSoFar) {
  testing::Random random(1);
  LargestValues largest = of_columns();
  std::vector<Row> rows;
  for (int n = 0; n < 200; ++n) {
    rows.push_back({random.between(-3, -1) + 0.01 * n, random.between(0, 1), 0, 0, 0, 0});
    largest.look_at(0.1 * n, rows.back());
    std::size_t best = 0;
    for (std::size_t m = 0; m < rows.size(); ++m)
      if (rows[m][0] > rows[best][0]) best = m;
    EXPECT_EQ(rows.back()[2], rows[best][0]);
    EXPECT_EQ(rows.back()[3], rows[best][1]);
    EXPECT_EQ(rows.back()[4], 0.1 * static_cast<double>(best));
    EXPECT_EQ(rows.back()[5], rows[best][0]);
  }
}

TEST(LargestValues, PassOverWhatIsNoNumberAndKeepTheFirstOfEquals) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LargestValues largest = of_columns();
  Row row;
  for (const auto& [value, other, expected] : std::vector<std::array<double, 3>>{
           {nan, 1, nan}, {2, 2, 2}, {nan, 3, 2}, {2, 4, 2}, {1, 5, 2}, {2.5, 6, 6}}) {
    row = {value, other, 0, 0, 0, 0};
    largest.look_at(0, row);
    if (!std::isnan(expected)) {
      EXPECT_EQ(row[3], expected);
    }
  }
  EXPECT_EQ(row[2], 2.5);
}

TEST(LargestValues, GoOnFromASnapshot) {
  LargestValues whole = of_columns(), first = of_columns(), second = of_columns();
  Row row{5, 1, 0, 0, 0, 0};
  whole.look_at(1, row);
  first.look_at(1, row);
  Snapshot between;
  LargestValues::each_member(first, "largest", between.saving());
  LargestValues::each_member(second, "largest", between.restoring());
  Row expected{4, 2, 0, 0, 0, 0}, found = expected;
  whole.look_at(2, expected);
  second.look_at(2, found);
  EXPECT_EQ(found, expected);
  EXPECT_EQ(found[4], 1);
}

}  // namespace
}  // namespace riven
