#include "input/field_format.hpp"

#include <fmt/format.h>

#include "input/table_format.hpp"

namespace riven {
namespace {

void check_not_a_table(const FieldInput& field, const Case& c, const Check& check) {
  for (const TableInput& table : c.tables)
    if (table.name == field.name)
      check.fail("", fmt::format("\"{}\" is the name of a table at {}; expected another name", field.name,
                                 table.at.text()));
}

// A file's mistakes stand where the case names the file, and say their own place.
void read(FieldInput& field, const Case& c, const Check& check) {
  try {
    field.field = read_field(field.name, c.file.parent_path() / field.file, field.value, c.geometry.dimension,
                             c.geometry.spacing);
  } catch (const InputError& wrong) {
    check.fail("file", wrong.what());
  }
}

}  // namespace

Format describe(FieldInput& field, const Case& c) {
  return {.doc =
              "Values at places, from a CSV file with the columns x, y, in three dimensions z, and one of "
              "values, each with its unit, as in `x [mm], y [mm], v [m/s]`. Formulas that know x, y, z read "
              "it by its name: with `[field.v0]`, `\"2 * v0\"` is twice the value of the nearest row, which "
              "must lie within half a spacing.",
          .at = &field.at,
          .keys = {Key{"file", kind::Text{&field.file}, "CSV file, relative to the case file."}.required(),
                   Key{"value", kind::Text{&field.value}, "Column of the value, where there are several."}},
          .finish = [&field, &c](const Check& check) {
            check_formula_name(field.name, "field", check);
            check_not_a_table(field, c, check);
            read(field, c, check);
            if (field.value.empty()) field.value = field.field->value().name;
          }};
}

}  // namespace riven
