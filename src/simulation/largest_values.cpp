#include "simulation/largest_values.hpp"

#include <cmath>
#include <limits>

namespace riven {

void LargestValues::add(const LargestColumn& column) {
  columns_.push_back(column);
  for (auto* values : {&largest_, &there_}) values->push_back(std::numeric_limits<double>::quiet_NaN());
}

void LargestValues::look_at(double parameter, std::vector<double>& row) {
  for (std::size_t n = 0; n < columns_.size(); ++n) {
    const auto& [column, of, gives] = columns_[n];
    if (std::isnan(largest_[n]) || row[of] > largest_[n]) {
      largest_[n] = row[of];
      there_[n] = gives ? row[*gives] : parameter;
    }
    row[column] = there_[n];
  }
}

}  // namespace riven
