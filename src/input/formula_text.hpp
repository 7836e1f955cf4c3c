#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "input/formula.hpp"

namespace riven {

/// Sizes of the base units, to see how a result depends on them.
struct UnitScale {
  double metre = 1;
  double second = 1;
  double kilogram = 1;
  double kelvin = 1;

  [[nodiscard]] double of(const Dimension& dimension) const;
};

/// A formula cut into text and quantities (numbers with units, dx, horizon).
class FormulaText {
 public:
  /// Throws InputError for unknown names and units.
  FormulaText(const std::string& text, const Symbols& symbols, const Origin& origin);

  /// The formula in muParser's language, in base units of the given sizes.
  [[nodiscard]] std::string si(const UnitScale& scale = {}) const;

  /// The tables and fields that it takes values from, as `si` of the same scale needs them; or their
  /// stand-ins.
  [[nodiscard]] FormulaData data(const UnitScale& scale, bool stand_in) const;
  [[nodiscard]] bool needs_data() const { return !tables_.empty() || !fields_.empty(); }
  /// For messages: "; the table pull takes a time and gives a length", for each that it calls.
  [[nodiscard]] std::string what_tables_take() const;

  [[nodiscard]] const std::string& written() const { return text_; }

 private:
  struct Piece {
    std::string text;                  // muParser's language
    std::optional<Quantity> quantity;  // instead of text
  };

  void scan();
  void scan_number();
  void scan_name();
  void scan_sign();
  void add(const Quantity& quantity) { pieces_.push_back({"", quantity}); }
  bool call_table(std::string_view name);
  bool use_field(std::string_view name);
  [[nodiscard]] std::vector<std::string> table_names() const;
  [[nodiscard]] std::vector<std::string> field_names() const;
  [[nodiscard]] std::optional<double> length_name(std::string_view name) const;
  [[nodiscard]] std::size_t after_spaces(std::size_t i) const;
  [[nodiscard]] char character(std::size_t i) const { return i < text_.size() ? text_[i] : '\0'; }
  void check_one_number(const std::string& digits, std::size_t at) const;
  void check_not_a_power(std::string_view name);
  void check_product(double number, std::size_t at);
  [[noreturn]] void fail_unknown(std::string_view name, std::size_t at) const;
  [[noreturn]] void fail(std::size_t offset, const std::string& message) const {
    origin_.fail(text_, offset, message);
  }

  std::string text_;
  const Symbols& symbols_;
  const Origin& origin_;
  std::size_t position_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::shared_ptr<const TableFunction>> tables_;  // that it calls, each once
  std::vector<std::shared_ptr<const FieldFunction>> fields_;  // that it reads, each once
};

}  // namespace riven
