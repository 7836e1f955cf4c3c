#pragma once

#include "input/format.hpp"

namespace riven {

/// [contact]
Format describe(std::optional<ContactInput>& contact, const Case& c);

/// [[impactor]]
Format describe(ImpactorInput& impactor, const Case& c);

/// Fails unless a probe's impactor exists.
void check_impactor(const std::string& name, const Case& c, const Check& check);

}  // namespace riven
