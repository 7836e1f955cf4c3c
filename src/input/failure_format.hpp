#pragma once

#include "input/case.hpp"
#include "input/format.hpp"

namespace riven {

/// Keys that say when bonds break: a stretch, or the energy release rate from which one follows.
std::vector<Key> limit_keys(std::optional<double>& stretch, std::optional<double>& energy_release_rate);

/// [[interface]]
Format describe(InterfaceInput& interface, const Case& c);

/// [failure]
Format describe(FailureInput& failure, const Case& c);

/// Of one material: its sets and limits. Throws InputError.
void check_limits(const MaterialInput& material, const Case& c, const Check& check);

/// That materials, interfaces and protected sets go together. Throws InputError.
void check_failure(const Case& c, const Check& check);

}  // namespace riven
