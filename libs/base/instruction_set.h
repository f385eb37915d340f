// SPDX-License-Identifier: BSD-3-Clause
// The instruction sets for which the kernels of inner loops exist. All kernels of a loop give the same
// result.
#pragma once

namespace psi_slam {

enum class InstructionSet { kBaseline, kAvx2, kAvx512 };  // each contains those before it

inline constexpr InstructionSet kInstructionSets[] = {InstructionSet::kBaseline, InstructionSet::kAvx2,
                                                      InstructionSet::kAvx512};

/// Returns whether this machine has an instruction set and the environment variable PSI_SLAM_MAX_INSTRUCTIONS
/// (baseline, avx2 or avx512) does not name a smaller one. Throws UserError if the variable has another
/// value.
bool can_use(InstructionSet set);

/// Returns the largest instruction set that can_use() allows.
InstructionSet widest_instruction_set();

}  // namespace psi_slam
