#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// The candidate that a typist most likely meant by `found` (fewest edits, case ignored); empty when none is
/// near.
std::string nearest_name(std::string_view found, const std::vector<std::string>& candidates);

/// `; did you mean "..."?`, or nothing when no candidate is near.
std::string did_you_mean(std::string_view found, const std::vector<std::string>& candidates);

/// `a, b, c`
std::string listed(const std::vector<std::string>& names);

}  // namespace riven
