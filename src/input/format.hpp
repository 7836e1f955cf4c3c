#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "input/case.hpp"
#include "input/units.hpp"

namespace riven {

/// The means by which `case_format.cpp` declares the case format, once. A Format is plain data: names, kinds,
/// defaults, ranges, rules, and pointers to the members of a Case. The reader fills the members through it;
/// the writer of resolved cases, the JSON Schema and the reference page read it.
struct Format;

/// Numbers that a key accepts, in SI.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  bool above_low = false;  // the lower end is excluded
  double high = std::numeric_limits<double>::infinity();
  bool below_high = false;  // the upper end is excluded
};
inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0, .above_low = true};
inline constexpr Range not_negative{.low = 0};
inline constexpr Range fraction{.low = 0, .above_low = true, .high = 1};

/// What stands behind a key, and the member that holds it. Empty members count as not given.
namespace kind {

struct Text {
  std::string* to;
  std::vector<std::string> among{};  // empty: any text
};
struct Texts {
  std::vector<std::string>* to;
  std::vector<std::string> among{};
};
struct Flag {
  bool* to;
};
struct Integer {
  int* to;
  int low;
};
struct Integers {
  std::vector<int>* to;
  int low;
};
struct Quantity {
  std::variant<double*, std::optional<double>*> to;
  Dimension dimension;
  Range range = any_number;
};
struct Quantities {
  std::vector<double>* to;
  Dimension dimension;
  Range range = any_number;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};
/// A number with a unit of the user's choice.
struct AnyUnit {
  std::optional<AnyQuantity>* to;
};
/// Lengths along the axes of the body, as many as it has dimensions.
struct Place {
  std::variant<Point*, std::optional<Point>*> to;
  Range range = any_number;
};
/// A list of such places.
struct Places {
  std::vector<Point>* to;
  std::size_t least;
};
/// A formula of x, y, z that is true or false.
struct Condition {
  std::optional<Expression>* to;
};
/// A formula of x, y, z and t or stretch.
struct Formula {
  std::optional<Expression>* to;
  Dimension dimension;
};
/// One value per direction, a formula of x, y, z and, unless it belongs to the start, t or stretch; or
/// "free".
struct Components {
  std::vector<ComponentInput>* to;
  Dimension dimension = dimension::length;
  bool at_start = false;
};
/// "5 min", "1000 steps" or "never".
struct Interval {
  CheckpointInterval* to;
};
/// The name of an edge or a set.
struct Part {
  Named* to;
};
/// One name of an edge or a set, or a list of them.
struct Parts {
  std::vector<Named>* to;
};
/// A table; `given` tells the writer whether the case has it.
struct Table {
  std::function<Format()> open;
  std::function<bool()> given;
};
/// An array of tables; `open(count())` appends one.
struct Tables {
  std::function<std::size_t()> count;
  std::function<Format(std::size_t)> open;
};
/// Tables under names of the user's choice; `add(name)` appends one.
struct NamedTables {
  std::function<std::size_t()> count;
  std::function<Format(std::size_t)> open;
  std::function<std::string&(std::size_t)> name;  // name(count()) appends one
};

}  // namespace kind

using Kind = std::variant<kind::Text, kind::Texts, kind::Flag, kind::Integer, kind::Integers, kind::Quantity,
                          kind::Quantities, kind::AnyUnit, kind::Place, kind::Places, kind::Condition,
                          kind::Formula, kind::Components, kind::Interval, kind::Part, kind::Parts,
                          kind::Table, kind::Tables, kind::NamedTables>;

/// A rule that holds while another key, read before, has one of some values.
struct When {
  std::string key;  // "method", or "solver.method" of another section
  const std::string* value;
  std::vector<std::string> among;

  [[nodiscard]] bool holds() const;
  [[nodiscard]] std::string text() const;  // `method = "verlet"`
};

/// One key of a table.
struct Key {
  std::string name;
  Kind kind;
  std::string doc;                        // one line
  std::optional<std::string> fallback{};  // the default, as TOML text
  std::optional<When> only{};             // given elsewhere, the key is an error
  bool is_required = false;
  std::optional<When> required_when{};

  /// Used when the key is not given; TOML text.
  Key&& otherwise(std::string toml) && {
    fallback = std::move(toml);
    return std::move(*this);
  }
  Key&& applies(When when) && {
    only = std::move(when);
    return std::move(*this);
  }
  /// Wherever the key applies it must be given.
  Key&& required() && {
    is_required = true;
    return std::move(*this);
  }
  Key&& required_if(When when) && {
    required_when = std::move(when);
    return std::move(*this);
  }

  [[nodiscard]] bool applies_now() const { return !only || only->holds(); }
  [[nodiscard]] bool needed_now() const;
};

/// Keys of which one at most may be given, and exactly one if `needed`.
struct Group {
  std::vector<std::string> keys;
  bool needed = true;
  std::optional<When> only{};
};

/// What checks across keys may ask and report.
class Check {
 public:
  virtual ~Check() = default;
  [[nodiscard]] virtual bool given(const std::string& key) const = 0;
  [[nodiscard]] virtual Location at(const std::string& key) const = 0;
  /// Throws InputError at the key, or at the table if the key is not given.
  [[noreturn]] virtual void fail(const std::string& key, const std::string& message) const = 0;
};

/// A table of the case file.
struct Format {
  std::string doc;
  Location* at = nullptr;
  std::vector<Key> keys;
  std::vector<Group> groups{};
  std::function<void(const Check&)> finish{};  // after all keys: conversions and checks across keys
};

/// The whole format over the members of `to`.
Format describe(Case& to);

/// Names that loads and probes may use: edges of the body and sets.
std::vector<std::string> edge_names(const Case& of);
std::vector<std::string> part_names(const Case& of);

/// Calls `visit(path, key)` for every key of a format, tables before their keys; paths as "load[].on",
/// "set.NAME.where".
void for_each_key(const Format& format, const std::string& path,
                  const std::function<void(const std::string&, const Key&)>& visit);

/// All keys of the format as such paths.
std::vector<std::string> all_keys();

}  // namespace riven
