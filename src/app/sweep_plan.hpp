#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/swept_keys.hpp"
#include "output/history.hpp"

namespace riven::app {

/// One combination of values.
struct SweepVariant {
  std::vector<std::size_t> rows;           // of each group of keys: which of its values
  std::vector<std::string> values;         // of each key
  std::vector<std::optional<SiValue>> si;  // the same
  std::string name;                        // of its folder: "geometry.horizon=4_dx,..."
  std::vector<std::string> set;            // overrides as for --set
};

/// What a chart shows: a column of the histories over another one, or a metric at the end over a key.
struct SweepPlot {
  std::string x, y;                // columns; x is a key's name if it has a number
  std::optional<std::size_t> key;  // number of the key
};

struct SweepPlan {
  std::filesystem::path file;
  std::string title;                // of the case
  unsigned long checksum = 0;       // of all values that decide what the variants give
  std::vector<SweptKeys> swept;     // as given
  std::vector<std::string> keys;    // all of them
  std::vector<std::string> labels;  // the same, shorter if they would be long
  std::vector<SweepVariant> variants;
  std::vector<HistoryColumn> first_probe;  // metrics of the case's first probe
  std::vector<SweepPlot> plots;            // that are asked for
  int jobs = 1;                            // runs side by side

  /// "geometry.horizon=4 dx, model.stabilisation=8"
  [[nodiscard]] std::string text(const SweepVariant& variant) const;
  /// The group of variants that differ in their seeds only; 0 for the first.
  [[nodiscard]] std::vector<std::size_t> groups() const;
  /// Whether there are several such groups of several variants.
  [[nodiscard]] bool repeats() const;
};

/// All combinations of the given keys, or of those of the case's study, each of which has been read, built
/// and checked. Throws InputError, naming the variant, for the first one that is wrong, and when as many as
/// are to run side by side do not fit into the memory.
SweepPlan plan_sweep(const SweepOptions& options);

}  // namespace riven::app
