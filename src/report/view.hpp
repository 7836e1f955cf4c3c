#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/result.hpp"
#include "report/thinning.hpp"

namespace riven {

/// A state whose field file is missing, damaged or unlike the others; `what` names it.
class UnusableState : public std::runtime_error {
 public:
  UnusableState(std::size_t number, const std::string& what) : std::runtime_error(what), state(number) {}
  std::size_t state;
};

/// The size of the fields of a result, which has some, as measured on a few of its states. Throws
/// UnusableState.
ViewSize measured(const Result& result);

/// The fields of a result as a page holds them, in at most `budget` bytes; states are read one by one. What
/// is left out for that is said in `notes`. Throws UnusableState, or InputError when nothing fits.
nlohmann::json view(const Result& result, const ViewSize& size, double budget,
                    std::vector<std::string>& notes);

}  // namespace riven
