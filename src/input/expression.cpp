#include "input/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace riven {

namespace {

// A table as the parser calls it.
struct Called {
  TableCall call;
  std::size_t interval = 0;        // of the last argument; the next one is mostly near
  std::optional<double> beyond{};  // the argument, where the table has no value
};

double call_table(void* data, double argument) {
  Called& called = *static_cast<Called*>(data);
  const TableCall& call = called.call;
  if (call.stand_in) return call.value_unit * call.table->stand_in(argument / call.argument_unit);
  if (!call.table->holds() && !call.table->covers(argument)) called.beyond = argument;
  return call.table->value(argument, called.interval);
}

// A field as the parser reads it.
struct Used {
  FieldUse use;
  double value = 0;
  // Loads are asked for the same places in the same order at every step, and to look one up takes longer than
  // the rest of the formula.
  std::vector<std::pair<Point, double>> known{};
  std::size_t next = 0;

  /// Sets the value; false where the field has none.
  bool read(const Point& x) {
    if (next >= known.size() || known[next].first != x) {
      if (!known.empty() && known.front().first == x) {
        next = 0;
      } else {
        const auto found = use.field->at(x);
        if (!found) return false;
        known.resize(next);
        known.emplace_back(x, *found);
      }
    }
    value = known[next++].second;
    return true;
  }
};

}  // namespace

struct Expression::Compiled {
  std::string written;
  Location at;
  Variables variables;  // the parser reads its variables here
  mu::Parser parser;
  std::set<std::string> used;
  std::vector<Called> tables;  // the parser points at them
  std::vector<Used> fields;    // and at their values

  Compiled(std::string text, const std::string& formula, Location place, FormulaData data)
      : written(std::move(text)), at(std::move(place)) {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &variables.position[0]);
    parser.DefineVar("y", &variables.position[1]);
    parser.DefineVar("z", &variables.position[2]);
    parser.DefineVar("t", &variables.t);
    parser.DefineVar("stretch", &variables.stretch);
    for (TableCall& call : data.tables) tables.push_back({std::move(call)});
    for (FieldUse& use : data.fields) fields.push_back({std::move(use)});
    for (Used& field : fields) {
      field.value = field.use.value_unit * field.use.field->stand_in();
      parser.DefineVar(field.use.field->name(), &field.value);
    }
    for (Called& table : tables)  // not to be folded into a constant while the parser compiles
      parser.DefineFunUserData(table.call.table->name(), &call_table, &table, false);
    parser.SetExpr(formula);
    for (const auto& [name, value] : parser.GetUsedVar()) used.insert(name);
    (void)parser.Eval();  // the first evaluation compiles; what does not compile must say so here
    if (parser.GetNumResults() != 1) throw mu::ParserError("a list of values where one is expected");
  }

  void read_fields() {
    for (Used& field : fields)
      if (!field.use.stand_in && !field.read(variables.position)) fail_without_row(*field.use.field);
  }

  [[noreturn]] void fail_without_row(const FieldFunction& field) const {
    const Point& x = variables.position;
    throw InputError(at,
                     fmt::format("\"{}\": the field {} has no value at ({:.6g}, {:.6g}, {:.6g}) m; expected "
                                 "a row of {} within half a spacing, {:.4g} m",
                                 written, field.name(), x[0], x[1], x[2], field.file(), field.reach()));
  }

  [[noreturn]] void fail_beyond(const Called& called) const {
    const TableFunction& table = *called.call.table;
    const std::vector<double>& range = table.argument().values;
    const auto text = [&](double value) {
      const Dimension& d = table.argument().dimension;
      return d == dimension::none ? fmt::format("{:.6g}", value)
                                  : fmt::format("{:.6g} {}", value, si_unit(d));
    };
    std::string where;
    const auto tell = [&](const char* name, double value, const char* unit) {
      if (used.contains(name))
        where += fmt::format("{}{} = {:.6g}{}", where.empty() ? "" : ", ", name, value, unit);
    };
    tell("x", variables.position[0], " m");
    tell("y", variables.position[1], " m");
    tell("z", variables.position[2], " m");
    tell("t", variables.t, " s");
    tell("stretch", variables.stretch, "");
    throw InputError(
        at,
        fmt::format("\"{}\": the table {} has no value at {}{}; {} goes from {} to {}; expected an argument "
                    "within, more rows, or outside = \"hold\" in [table.{}]",
                    written, table.name(), text(*called.beyond),
                    where.empty() ? "" : fmt::format(" (at {})", where), table.file().string(),
                    text(range.front()), text(range.back()), table.name()));
  }
};

Expression::Expression(std::string written, const std::string& formula, const Location& at,
                       FormulaData data) try
    : compiled_(std::make_shared<Compiled>(std::move(written), formula, at, std::move(data))) {
} catch (const mu::ParserError& error) {
  // muParser counts in the formula with SI numbers, which the user does not see.
  const std::string& message = error.GetMsg();
  throw InputError(
      at, "formula cannot be read: " + message.substr(0, std::min(message.find(" at position"),
                                                                  message.find(" at expression position"))));
}

double Expression::operator()(const Variables& variables) const {
  compiled_->variables = variables;
  compiled_->read_fields();
  for (Called& table : compiled_->tables) table.beyond.reset();
  const double result = compiled_->parser.Eval();
  for (const Called& table : compiled_->tables)
    if (table.beyond) compiled_->fail_beyond(table);
  return result;
}

const std::string& Expression::written() const {
  return compiled_->written;
}

bool Expression::depends_on(const std::string& variable) const {
  return compiled_->used.contains(variable);
}

bool Expression::calls_tables() const {
  return !compiled_->tables.empty();
}

bool Expression::reads_fields() const {
  return !compiled_->fields.empty();
}

const Location& Expression::location() const {
  return compiled_->at;
}

}  // namespace riven
