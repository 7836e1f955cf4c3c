#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "geometry/shape.hpp"
#include "input/field_function.hpp"
#include "input/table_function.hpp"

namespace riven {

/// What an expression of a case file may depend on; SI units.
struct Variables {
  Point position{};  // x, y, z (m)
  double t = 0;      // s
  double stretch = 1;
};

/// A table that a formula calls.
struct TableCall {
  std::shared_ptr<const TableFunction> table;
  double argument_unit = 1;  // the formula's units in SI, as a check of dimensions varies them
  double value_unit = 1;
  bool stand_in = false;  // call the table's stand-in: for such checks
};

/// A field that a formula reads at its place.
struct FieldUse {
  std::shared_ptr<const FieldFunction> field;
  double value_unit = 1;  // as of tables
  bool stand_in = false;
};

/// What a formula takes from files.
struct FormulaData {
  std::vector<TableCall> tables;
  std::vector<FieldUse> fields;
};

/// A function of x, y, z, t and stretch that the user wrote; already in SI units. Copies are cheap and share
/// the compiled formula; evaluate one expression from one thread at a time.
class Expression {
 public:
  Expression() = default;
  /// `formula`: in SI units and muParser's language. Throws InputError at `at` when it does not parse.
  Expression(std::string written, const std::string& formula, const Location& at, FormulaData data = {});

  /// Throws InputError when a table is asked for a value beyond its ends and does not hold it, or a field for
  /// one where it has none.
  double operator()(const Variables& variables) const;

  [[nodiscard]] const std::string& written() const;  // as the user wrote it
  [[nodiscard]] bool depends_on(const std::string& variable) const;
  [[nodiscard]] bool calls_tables() const;
  [[nodiscard]] bool reads_fields() const;
  [[nodiscard]] const Location& location() const;

 private:
  struct Compiled;
  std::shared_ptr<Compiled> compiled_;
};

}  // namespace riven
