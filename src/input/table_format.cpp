#include "input/table_format.hpp"

#include <fmt/format.h>

#include "input/formula.hpp"

namespace riven {
namespace {

// A file's mistakes stand where the case names the file, and say their own place.
void read(TableInput& table, const Case& c, const Check& check) {
  try {
    table.function = std::make_shared<const TableFunction>(read_table(
        table.name, c.file.parent_path() / table.file, table.argument, table.value, table.outside == "hold"));
  } catch (const InputError& wrong) {
    check.fail("file", wrong.what());
  }
}

}  // namespace

void check_formula_name(const std::string& name, const char* what, const Check& check) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
  if (name.find_first_not_of(std::string(kLetters) + "0123456789_") != std::string::npos ||
      name.find_first_of(kLetters) != 0)
    check.fail("", fmt::format("found the name \"{}\", which formulas could not use; expected a letter, "
                               "then letters, digits and _",
                               name));
  const std::string taken = meaning_in_formulas(name);
  if (!taken.empty())
    check.fail("", fmt::format("\"{}\" is {} in formulas; expected another name, such as \"{}_{}\"", name,
                               taken, name, what));
}

Format describe(TableInput& table, const Case& c) {
  return {.doc =
              "A function of one variable from a CSV file, linear between its points. Formulas call it by "
              "its name: with `[table.pull]`, `\"pull(t)\"`. The names of the columns end in their units, "
              "as in `time [ms], displacement [mm]`; without a unit they are plain numbers.",
          .at = &table.at,
          .keys = {Key{"file", kind::Text{&table.file}, "CSV file, relative to the case file."}.required(),
                   Key{"argument", kind::Text{&table.argument},
                       "Column of the argument, rising from row to row; the first unless given."},
                   Key{"value", kind::Text{&table.value}, "Column of the value; the second unless given."},
                   Key{"outside", kind::Text{&table.outside, {"error", "hold"}},
                       "Beyond its ends the table is an error, found before the run, or holds its first and "
                       "last value."}
                       .otherwise("\"error\"")},
          .finish = [&table, &c](const Check& check) {
            check_formula_name(table.name, "table", check);
            read(table, c, check);
            if (table.argument.empty()) table.argument = table.function->argument().name;
            if (table.value.empty()) table.value = table.function->value().name;
          }};
}

}  // namespace riven
