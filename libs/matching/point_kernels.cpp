// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_kernels.h"

namespace psi_slam {

const PointKernels* point_kernels_for(InstructionSet set) {
  if (!can_use(set)) return nullptr;
#ifdef PSI_SLAM_X86_KERNELS
  if (set == InstructionSet::kAvx2) return &point_kernels_avx2();
  if (set == InstructionSet::kAvx512) return &point_kernels_avx512();
#endif
  return &point_kernels_baseline();
}

const PointKernels& point_kernels() {
  static const PointKernels& kernels = *point_kernels_for(widest_instruction_set());
  return kernels;
}

}  // namespace psi_slam
