#pragma once

#include <stdexcept>

namespace riven {

/// A factorisation that could not be made: memory, in general.
class FactorFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace riven
