#include "base/instruction_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "base/error.hpp"

namespace riven {

namespace {

constexpr std::array kAll = {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};

std::optional<InstructionSet> chosen;

InstructionSet best() {
  return *std::find_if(kAll.rbegin(), kAll.rend(), supported);
}

InstructionSet from_environment() {
  const char* asked = std::getenv("RIVEN_INSTRUCTIONS");
  if (asked == nullptr || *asked == '\0') return best();
  const auto found =
      std::find_if(kAll.begin(), kAll.end(), [&](InstructionSet set) { return name(set) == asked; });
  if (found == kAll.end())
    throw InputError(
        fmt::format("RIVEN_INSTRUCTIONS: found \"{}\"; expected portable, avx2 or avx512", asked));
  if (!supported(*found))
    throw InputError(
        fmt::format("RIVEN_INSTRUCTIONS: this processor has no {}; it has {}", asked, name(best())));
  return *found;
}

}  // namespace

std::string_view name(InstructionSet set) {
  constexpr std::array<std::string_view, kAll.size()> names = {"portable", "avx2", "avx512"};
  return names[static_cast<std::size_t>(set)];
}

bool supported(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::avx512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  if (set == InstructionSet::avx2) return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#endif
  return set == InstructionSet::portable;
}

InstructionSet instruction_set() {
  if (!chosen) chosen = from_environment();
  return *chosen;
}

void use_instruction_set(InstructionSet set) {
  chosen = set;
}

}  // namespace riven
