#pragma once

#include <string_view>

namespace riven {

/// For which vectors a kernel is compiled. All are in the program; a run uses the best that the processor
/// has.
enum class InstructionSet { portable, avx2, avx512 };

std::string_view name(InstructionSet set);

/// Whether this processor has it.
bool supported(InstructionSet set);

/// The one in use: what `use_instruction_set` chose, else what the environment variable RIVEN_INSTRUCTIONS
/// names (portable, avx2 or avx512), else the best there is. Throws InputError for a name that is none, or
/// that the processor lacks.
InstructionSet instruction_set();

/// Takes one from now on, on all threads. Not to be called while a kernel runs.
void use_instruction_set(InstructionSet set);

}  // namespace riven
