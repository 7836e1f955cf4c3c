#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace riven {

/// One expectation held against a result.
struct Verdict {
  std::string what;  // metric, or "displacement field"
  std::string unit;
  double at = 0;  // stretch, time (s) or cycle
  bool published = false;
  bool decides = true;             // a reference; published values are only reported
  std::optional<double> expected;  // none for a field
  std::optional<double> ours;      // the metric; none for a field
  std::optional<double>
      deviation;      // of a metric relative to what is expected if that is not 0; of a field L2
  std::string limit;  // what was asked: "0.5 %", ">= 2"
  bool met = true;
  std::string source;
};

/// How it reads in a table: "ok", "missed", or "reported" where it does not decide.
constexpr std::string_view outcome(const Verdict& verdict) {
  return !verdict.decides ? "reported" : verdict.met ? "ok" : "missed";
}

}  // namespace riven
