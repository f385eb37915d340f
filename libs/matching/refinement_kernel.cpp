// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement_kernel.h"

namespace psi_slam {

RefinementKernel refinement_kernel_for(InstructionSet set) {
  if (!can_use(set)) return nullptr;
#ifdef PSI_SLAM_X86_KERNELS
  if (set == InstructionSet::kAvx2) return refinement_kernel_avx2();
  if (set == InstructionSet::kAvx512) return refinement_kernel_avx512();
#endif
  return refinement_kernel_baseline();
}

RefinementKernel refinement_kernel() {
  static const RefinementKernel kernel = refinement_kernel_for(widest_instruction_set());
  return kernel;
}

}  // namespace psi_slam
