#pragma once

#include <string_view>

namespace riven {

/// What numbers the states of a run: the applied stretch, the time (s) or the load cycle.
enum class Parameter { stretch, time, cycle };

/// "stretch", "time" or "cycle": the key in `summary.json`.
constexpr std::string_view name(Parameter parameter) {
  switch (parameter) {
    case Parameter::stretch:
      return "stretch";
    case Parameter::time:
      return "time";
    case Parameter::cycle:
      return "cycle";
  }
  return "";
}

/// Unit of the parameter; empty without one.
constexpr std::string_view unit(Parameter parameter) {
  return parameter == Parameter::time ? "s" : "";
}

}  // namespace riven
