#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "input/expression.hpp"
#include "input/units.hpp"

namespace riven {

/// Where a value of a case file stands: messages name its key and its place.
struct Origin {
  std::string key;  // "load.1.displacement", entries counted from 1
  Location at;
  int text_column = 0;  // column of a string's first character; 0 = unknown

  [[noreturn]] void fail(const std::string& message) const;
  /// Points at character `offset` of the text, where its column is known.
  [[noreturn]] void fail(std::string_view text, std::size_t offset, const std::string& message) const;
};

/// The names that a formula may use besides functions, "pi" and units.
struct Symbols {
  std::optional<double> dx;            // m; known once the body's lattice has been read
  std::optional<double> horizon;       // m
  std::vector<std::string> variables;  // of x, y, z, t, stretch
  std::vector<std::shared_ptr<const TableFunction>> tables{};
  std::vector<std::shared_ptr<const FieldFunction>> fields{};  // read where x is a variable
};

/// A formula with units, such as "2 MPa * (1 - cos(2*pi*10*t))", whose result has the given dimension.
Expression parse_formula(const std::string& text, const Dimension& dimension, const Symbols& symbols,
                         const Origin& origin);

/// A formula that is true or false, such as "abs(y) > 20 mm - dx".
Expression parse_condition(const std::string& text, const Symbols& symbols, const Origin& origin);

/// A value with its dimension, in SI.
struct Quantity {
  double si = 0;
  Dimension dimension;
};

/// A constant formula of any dimension: "3.8 J/m^2".
Quantity parse_quantity(const std::string& text, const Symbols& symbols, const Origin& origin);

/// A constant formula of the given dimension: "20 mm - dx". A plain 0 has every dimension.
double parse_quantity(const std::string& text, const Dimension& dimension, const Symbols& symbols,
                      const Origin& origin);

/// What a name already means in a formula: "a function", "a unit"; empty for a new name.
std::string meaning_in_formulas(const std::string& name);

/// The message about a number without a unit: `10 has no unit; write "10 mm" (a length)`.
std::string needs_unit(const std::string& number, const Dimension& dimension);

}  // namespace riven
