// SPDX-License-Identifier: BSD-3-Clause
#include "matching/sum_kernel.h"

namespace psi_slam {

SumKernel sum_kernel_for(InstructionSet set) {
  if (!can_use(set)) return nullptr;
#ifdef PSI_SLAM_X86_KERNELS
  if (set != InstructionSet::kBaseline) return sum_kernel_avx2();
#endif
  return sum_kernel_baseline();
}

SumKernel sum_kernel() {
  static const SumKernel kernel = sum_kernel_for(widest_instruction_set());
  return kernel;
}

}  // namespace psi_slam
