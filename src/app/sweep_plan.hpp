#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "input/case.hpp"
#include "output/history.hpp"

namespace riven::app {

/// A key of the case and the values that it is to take.
struct SweptKey {
  std::string name;                 // as for --set
  std::vector<std::string> values;  // as the user wrote them
};

/// `KEY=a,b,c`. Throws InputError when a part is missing, or a value stands there twice.
SweptKey swept_key(const std::string& text);

/// A plain value of a resolved case in SI; the unit is empty without one.
struct SiValue {
  double value = 0;
  std::string unit;
};

/// What a key of a case reads after all units and formulas are resolved; nothing if it is no single number.
std::optional<SiValue> value_in_si(const Case& input, const std::string& key);

/// One combination of values.
struct SweepVariant {
  std::vector<std::string> values;         // of each key
  std::vector<std::optional<SiValue>> si;  // the same
  std::string name;                        // of its folder: "geometry.horizon=4_dx,..."
  std::vector<std::string> set;            // overrides as for --set
};

struct SweepPlan {
  std::filesystem::path file;
  std::string title;           // of the case
  unsigned long checksum = 0;  // of all values that decide what the variants give
  std::vector<SweptKey> keys;
  std::vector<SweepVariant> variants;
  std::vector<HistoryColumn> first_probe;  // metrics of the case's first probe

  /// "geometry.horizon=4 dx, model.stabilisation=8"
  [[nodiscard]] std::string text(const SweepVariant& variant) const;
};

/// All combinations, each of which has been read, built and checked. Throws InputError, naming the variant,
/// for the first one that is wrong, and when as many as run side by side do not fit into the memory.
SweepPlan plan_sweep(const SweepOptions& options);

}  // namespace riven::app
