#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/defects.hpp"
#include "geometry/shape.hpp"
#include "verification/reference_points.hpp"

namespace riven {

/// What a comparison must know of the body besides its points; lengths in metres.
struct CompareSettings {
  Defects defects;
  double spacing = 0;
  double horizon = 0;
  double exclude_within = 0;  // reference points nearer than this to an edge of a defect are left out
};

/// The live points of a result at one state.
struct ResultState {
  double value = 0;                  // stretch, time (s) or cycle
  std::vector<Point> positions;      // m, undeformed
  std::vector<Point> displacements;  // m
};

/// How far one state is from its reference.
struct StateDeviation {
  double value = 0;        // of the result's state
  double relative_l2 = 0;  // sqrt(sum |u - u_ref|^2 / sum |u_ref|^2)
  double maximum = 0;      // largest |u - u_ref| (m)
  Point maximum_at{};      // m, undeformed
  int used = 0;            // reference points compared
  int excluded = 0;        // left out by exclude_within
  int outside = 0;         // left out because the result has no displacement there
};

struct FieldDeviation {
  std::vector<StateDeviation> states;
  std::vector<double> missing;     // reference states that the result lacks
  std::vector<double> uncompared;  // states of the result that the reference lacks
};

/// Compares one state with reference points, at their positions (Interpolation says how).
/// `dimension`: the number of components to compare.
/// Throws InputError when no reference point can be compared.
StateDeviation compare_state(const ResultState& state, const std::vector<ReferencePoint>& points,
                             int dimension, const CompareSettings& settings);

/// Compares the states of a result folder (`fields.pvd` and its files) with those of the reference, matched
/// by value within 1e-6 relative; a reference without states is compared with the last one. Points that have
/// lost all bonds (field `damage` = 1) are not live. Throws InputError when a file is missing or damaged, has
/// no `displacement`, or nothing can be compared.
FieldDeviation compare_fields(const std::filesystem::path& folder, const ReferencePoints& reference,
                              const CompareSettings& settings);

/// How far a history is from a reference curve.
struct HistoryDeviation {
  double relative_l2 = 0;
  double maximum = 0;     // in the unit of the metric
  double maximum_at = 0;  // stretch, time (s) or cycle
  int used = 0;           // rows of the reference compared
  int outside = 0;        // rows beyond the ends of the history
};

/// Compares the column `metric` of a `history.csv` with the column `column` of a reference CSV file, whose
/// states are in the column lambda, stretch, t_s, time or cycle, else in the first. The history is
/// interpolated linearly in its first column. Columns of the reference that name a unit, as in "F [kN]", are
/// converted. Throws InputError when a file or column is missing or damaged, a unit does not fit, the history
/// runs to and fro, or no row overlaps.
HistoryDeviation compare_history(const std::filesystem::path& history, const std::filesystem::path& reference,
                                 std::string_view metric, std::string_view column);

/// Tables to read; each ends with a line end.
std::string table(const FieldDeviation& deviation);
std::string table(const HistoryDeviation& deviation);

/// {"states": [{"value", "relative_l2", "maximum", "maximum_at", "used", "excluded", "outside"}], "missing":
/// [...], "uncompared": [...]}; what is not finite is null.
nlohmann::ordered_json to_json(const FieldDeviation& deviation);
/// {"relative_l2", "maximum", "maximum_at", "used", "outside"}.
nlohmann::ordered_json to_json(const HistoryDeviation& deviation);

}  // namespace riven
