#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace riven {

/// A column of the history that keeps the largest value of another one, or what a third one was there.
struct LargestColumn {
  std::size_t column = 0;
  std::size_t of = 0;                // an earlier column
  std::optional<std::size_t> gives;  // an earlier column; nothing: stretch or time
};

/// What such columns keep from row to row.
class LargestValues {
 public:
  void add(const LargestColumn& column);

  /// Fills in the columns of a row whose other values are known. Values that are no numbers are passed over.
  void look_at(double parameter, std::vector<double>& row);

  template <class Self, class Each>
  static void each_member(Self& self, const std::string& name, const Each& each) {
    each(name, self.largest_);
    each(name + ".there", self.there_);
  }

 private:
  std::vector<LargestColumn> columns_;
  std::vector<double> largest_, there_;  // of each column, so far
};

}  // namespace riven
