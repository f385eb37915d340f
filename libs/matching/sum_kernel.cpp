// SPDX-License-Identifier: BSD-3-Clause
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

bool machine_has([[maybe_unused]] InstructionSet set) {
#ifdef PSI_SLAM_X86_KERNELS
  __builtin_cpu_init();
  if (set == InstructionSet::kAvx2) return __builtin_cpu_supports("avx2") != 0;
  if (set == InstructionSet::kAvx512)
    return __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#endif
  return set == InstructionSet::kBaseline;
}

}  // namespace

SumKernel sum_kernel_for(InstructionSet set) {
  if (!machine_has(set)) return nullptr;
#ifdef PSI_SLAM_X86_KERNELS
  if (set == InstructionSet::kAvx2) return sum_kernel_avx2();
  if (set == InstructionSet::kAvx512) return sum_kernel_avx512();
#endif
  return sum_kernel_baseline();
}

SumKernel sum_kernel() {
  static const SumKernel kernel =
      sum_kernel_for(machine_has(InstructionSet::kAvx512) ? InstructionSet::kAvx512
                     : machine_has(InstructionSet::kAvx2) ? InstructionSet::kAvx2
                                                          : InstructionSet::kBaseline);
  return kernel;
}

}  // namespace psi_slam
