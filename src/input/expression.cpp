#include "input/expression.hpp"

#include <muParser.h>

#include <numbers>
#include <set>
#include <utility>

namespace riven {

struct Expression::Compiled {
  std::string written;
  Location at;
  Variables variables;  // the parser reads its variables here
  mu::Parser parser;
  std::set<std::string> used;

  Compiled(std::string text, const std::string& formula, Location place)
      : written(std::move(text)), at(std::move(place)) {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("x", &variables.position[0]);
    parser.DefineVar("y", &variables.position[1]);
    parser.DefineVar("z", &variables.position[2]);
    parser.DefineVar("t", &variables.t);
    parser.DefineVar("stretch", &variables.stretch);
    parser.SetExpr(formula);
    for (const auto& [name, value] : parser.GetUsedVar()) used.insert(name);
    (void)parser.Eval();  // the first evaluation compiles; what does not compile must say so here
    if (parser.GetNumResults() != 1) throw mu::ParserError("a list of values where one is expected");
  }
};

Expression::Expression(std::string written, std::string formula, const Location& at) try
    : compiled_(std::make_shared<Compiled>(std::move(written), formula, at)) {
} catch (const mu::ParserError& error) {
  // muParser counts in the formula with SI numbers, which the user does not see.
  const std::string message = error.GetMsg();
  throw InputError(at, "formula cannot be read: " + message.substr(0, message.find(" at position")));
}

double Expression::operator()(const Variables& variables) const {
  compiled_->variables = variables;
  return compiled_->parser.Eval();
}

const std::string& Expression::written() const {
  return compiled_->written;
}

bool Expression::depends_on(const std::string& variable) const {
  return compiled_->used.contains(variable);
}

const Location& Expression::location() const {
  return compiled_->at;
}

}  // namespace riven
