// SPDX-License-Identifier: BSD-3-Clause
#include "matching/sum_kernel_body.h"

namespace psi_slam {

SumKernel sum_kernel_avx2() {
  return &sum_block;
}

}  // namespace psi_slam
