// SPDX-License-Identifier: BSD-3-Clause
#include "base/instruction_set.h"

#include <cstdlib>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr const char* kVariable = "PSI_SLAM_MAX_INSTRUCTIONS";

InstructionSet largest_allowed() {
  const char* const value = std::getenv(kVariable);
  const std::string name = value == nullptr ? "avx512" : value;
  if (name == "avx512") return InstructionSet::kAvx512;
  if (name == "avx2") return InstructionSet::kAvx2;
  if (name == "baseline") return InstructionSet::kBaseline;
  throw UserError("the environment variable " + std::string(kVariable) + " is " + name +
                  ", expected baseline, avx2 or avx512. Correct or unset it");
}

bool machine_has([[maybe_unused]] InstructionSet set) {
#ifdef __x86_64__
  __builtin_cpu_init();
  if (set == InstructionSet::kAvx2) return __builtin_cpu_supports("avx2") != 0;
  if (set == InstructionSet::kAvx512)
    return __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
           __builtin_cpu_supports("avx512vl") != 0;
#endif
  return set == InstructionSet::kBaseline;
}

}  // namespace

bool can_use(InstructionSet set) {
  return set <= largest_allowed() && machine_has(set);
}

InstructionSet widest_instruction_set() {
  if (can_use(InstructionSet::kAvx512)) return InstructionSet::kAvx512;
  return can_use(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kBaseline;
}

}  // namespace psi_slam
