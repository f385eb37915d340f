// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement_kernel_body.h"

namespace psi_slam {

RefinementKernel refinement_kernel_baseline() {
  return &sum_scores;
}

}  // namespace psi_slam
