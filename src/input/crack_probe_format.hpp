#pragma once

#include "input/format.hpp"

namespace riven {

/// Kinds of [[probe]] that follow cracks.
const std::vector<std::string>& crack_probe_kinds();

/// The keys that only such probes have.
std::vector<Key> crack_probe_keys(ProbeInput& probe);

/// What these kinds ask of the rest of the case.
void check_crack_probe(const ProbeInput& probe, const Case& c, const Check& check);

}  // namespace riven
