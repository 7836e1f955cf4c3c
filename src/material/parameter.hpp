#pragma once

#include <optional>
#include <string>
#include <vector>

namespace riven {

/// What a parameter of a law is, for the case format and its documentation. A law calls each(name, member,
/// ParameterKind) for all of its parameters, in `each_parameter`; the member is a double or a list of
/// doubles.
struct ParameterKind {
  enum class Unit { none, pressure };
  enum class Range { any, positive, poissons_ratio };
  Unit unit = Unit::pressure;
  std::string doc;
  Range range = Range::any;
  std::optional<double> fallback{};  // without: the parameter must be given
  /// Parameters of a law that differ in the factor are different ways to give one member, member = factor
  /// times parameter: exactly one of them is given.
  std::optional<double> factor{};
};

}  // namespace riven
