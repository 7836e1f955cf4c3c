#pragma once

#include <optional>
#include <string>
#include <vector>

#include "input/case.hpp"

namespace riven::app {

/// Keys of the case that change together, and the values that they are to take.
struct SweptKeys {
  std::vector<std::string> names;                // as for --set
  std::vector<std::vector<std::string>> values;  // one per name, as the user wrote them

  /// "geometry.horizon"; "number, radius" of several.
  [[nodiscard]] std::string name() const;
  /// "4 dx"; "(12, 6 mm)" of several.
  [[nodiscard]] std::string text(std::size_t row) const;
  /// Whether all of them are seeds: their values give repetitions of one thing.
  [[nodiscard]] bool repeats() const;
};

/// `KEY=a,b,c`, or `KEY1,KEY2=(a,b),(c,d)`. Throws InputError when a part is missing, or a value stands there
/// twice.
SweptKeys swept_keys(const std::string& text);

/// All of them; a key must stand there once.
std::vector<SweptKeys> all_swept_keys(const std::vector<std::string>& texts);

/// The last part of a key: "horizon" of geometry.horizon, "stretch.1" of solver.stretch.1.
std::string last_part(const std::string& key);

/// The last parts of keys; the whole keys if two would read the same.
std::vector<std::string> short_names(const std::vector<std::string>& keys);

/// A plain value of a resolved case in SI; the unit is empty without one.
struct SiValue {
  double value = 0;
  std::string unit;
};

/// What a key of a case reads after all units and formulas are resolved; nothing if it is no single number.
std::optional<SiValue> value_in_si(const Case& input, const std::string& key);

}  // namespace riven::app
