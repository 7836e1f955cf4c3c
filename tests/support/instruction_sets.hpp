#pragma once

#include <vector>

#include "base/instruction_set.hpp"

namespace riven::testing {

inline std::vector<InstructionSet> all_sets() {
  return {InstructionSet::portable, InstructionSet::avx2, InstructionSet::avx512};
}

inline std::vector<InstructionSet> supported_sets() {
  std::vector<InstructionSet> sets;
  for (const auto set : all_sets())
    if (supported(set)) sets.push_back(set);
  return sets;
}

/// Runs with one instruction set and puts the former one back.
class UseSet {
 public:
  explicit UseSet(InstructionSet set) : before_(instruction_set()) { use_instruction_set(set); }
  ~UseSet() { use_instruction_set(before_); }
  UseSet(const UseSet&) = delete;
  UseSet& operator=(const UseSet&) = delete;

 private:
  InstructionSet before_;
};

}  // namespace riven::testing
