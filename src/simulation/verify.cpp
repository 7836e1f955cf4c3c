#include "simulation/verify.hpp"

#include "simulation/build_parts.hpp"
#include "simulation/preflight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "output/summary.hpp"

namespace riven {

namespace {

/// Three digits; what is below rounding is nothing.
std::string percent(double fraction) {
  if (std::abs(fraction) < 1e-10) return "0 %";
  return std::abs(fraction) < 10 ? fmt::format("{:.3g} %", 100 * fraction)
                                 : fmt::format("{:.0f} %", 100 * fraction);
}

class Judge {
 public:
  Judge(const Case& input, const std::filesystem::path& folder)
      : input_(input), folder_(folder), summary_(read_summary(folder / "summary.json")) {}

  void add(const ExpectInput& expect) {
    if (expect.metric.empty()) {
      add_field(expect);
    } else {
      add_metric(expect);
    }
  }

  std::vector<Verdict> verdicts;

 private:
  [[nodiscard]] const SummaryState& state(const ExpectInput& expect) const {
    if (summary_.states.empty())
      throw InputError(expect.at, "expect: the run has no output state to compare");
    if (!expect.state) return summary_.states.back();
    for (const SummaryState& state : summary_.states)
      if (same_state(state.value, *expect.state)) return state;
    throw InputError(expect.at, fmt::format("expect: the result has no output state at {:g}", *expect.state));
  }

  void add_metric(const ExpectInput& given) {
    const SummaryState& at = state(given);
    const auto found = at.metrics.find(given.metric);
    if (found == at.metrics.end()) {
      std::string known;
      for (const auto& [name, metric] : at.metrics) known += (known.empty() ? "" : ", ") + name;
      throw InputError(given.at, fmt::format("expect: the case has no metric \"{}\"; its probes give {}",
                                             given.metric, known));
    }
    const Metric& ours = found->second;
    const ExpectInput expect = in_unit_of_metric(given, ours.unit);
    Verdict verdict{.what = expect.metric,
                    .unit = ours.unit,
                    .at = at.value,
                    .ours = ours.value,
                    .source = expect.source};
    verdict.published = expect.kind == "published";
    verdict.decides = !verdict.published;
    if (expect.value) hold_against_value(expect, ours.value, verdict);
    if (expect.min) verdict.met = verdict.met && ours.value >= expect.min->si;
    if (expect.max) verdict.met = verdict.met && ours.value <= expect.max->si;
    if (expect.min) verdict.limit += fmt::format(">= {:.6g}{}", expect.min->si, expect.max ? " " : "");
    if (expect.max) verdict.limit += fmt::format("<= {:.6g}", expect.max->si);
    verdict.met = verdict.met && std::isfinite(ours.value);
    verdicts.push_back(verdict);
  }

  static void hold_against_value(const ExpectInput& expect, double ours, Verdict& verdict) {
    const double wanted = expect.value->si;
    verdict.expected = wanted;
    const double deviation = wanted != 0 ? (ours - wanted) / std::abs(wanted) : ours;
    if (wanted != 0) verdict.deviation = deviation;
    if (expect.tolerance) {
      verdict.met = std::abs(deviation) <= *expect.tolerance;
      verdict.limit = percent(*expect.tolerance);
    }
    if (expect.absolute_tolerance) {
      verdict.met = std::abs(ours - wanted) <= expect.absolute_tolerance->si;
      verdict.limit = fmt::format("{:.3g} {}", expect.absolute_tolerance->si, verdict.unit);
    }
  }

  void add_field(const ExpectInput& expect) {
    ReferencePoints reference = read_reference_points(input_.file.parent_path() / expect.file);
    if (expect.state)
      std::erase_if(reference.states,
                    [&](const ReferenceState& s) { return s.value && !same_state(*s.value, *expect.state); });
    const FieldDeviation field =
        compare_fields(folder_, reference, compare_settings(input_, expect.exclude_within));
    for (const StateDeviation& state : field.states)
      verdicts.push_back({.what = expect.field + " field",
                          .at = state.value,
                          .published = expect.kind == "published",
                          .decides = expect.kind == "reference",
                          .deviation = state.relative_l2,
                          .limit = percent(expect.tolerance.value_or(0)),
                          .met = !expect.tolerance || state.relative_l2 <= *expect.tolerance,
                          .source = expect.source});
  }

  const Case& input_;
  const std::filesystem::path& folder_;
  Summary summary_;
};

}  // namespace

CompareSettings compare_settings(const Case& input, double exclude_within) {
  CompareSettings settings;
  for (const HoleInput& hole : input.holes) settings.defects.holes.push_back(hole.shape);
  for (const CrackInput& crack : input.cracks) add_crack(crack, settings.defects);
  for (const InclusionInput& inclusion : input.inclusions)
    settings.defects.inclusions.push_back(inclusion.shape);
  settings.spacing = input.geometry.spacing;
  settings.horizon = input.geometry.horizon;
  settings.exclude_within = exclude_within;
  return settings;
}

std::vector<Verdict> judge(const Case& input, const std::vector<ExpectInput>& expects,
                           const std::filesystem::path& folder) {
  Judge judge(input, folder);
  for (const ExpectInput& expect : expects) judge.add(expect);
  return std::move(judge.verdicts);
}

VerdictCells cells(const Verdict& v) {
  const std::string expected = v.expected ? fmt::format("{:.6g}", *v.expected) : v.ours ? "-" : "";
  return {v.unit.empty() ? v.what : v.what + " [" + v.unit + "]",
          fmt::format("{:.6g}", v.at),
          v.published ? expected : "",
          v.published ? "" : expected,
          v.ours ? fmt::format("{:.6g}", *v.ours) : "",
          v.deviation ? percent(*v.deviation) : "",
          v.limit,
          outcome(v) == "missed" ? "MISSED" : std::string(outcome(v))};
}

std::string table(const std::vector<Verdict>& verdicts) {
  constexpr std::size_t kColumns = kVerdictColumns.size();
  std::vector<VerdictCells> rows(1);
  std::copy(kVerdictColumns.begin(), kVerdictColumns.end(), rows.front().begin());
  for (const Verdict& verdict : verdicts) rows.push_back(cells(verdict));
  std::array<std::size_t, kColumns> width{};
  for (const VerdictCells& row : rows)
    for (std::size_t c = 0; c < kColumns; ++c) width[c] = std::max(width[c], row[c].size());
  std::string text;
  for (const VerdictCells& row : rows) {
    text += fmt::format("  {:<{}}", row[0], width[0]);
    for (std::size_t c = 1; c + 1 < kColumns; ++c) text += fmt::format("  {:>{}}", row[c], width[c]);
    text += row.back().empty() ? "\n" : fmt::format("  {}\n", row.back());
  }
  return text;
}

}  // namespace riven
