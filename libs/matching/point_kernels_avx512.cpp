// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_kernels_body.h"

namespace psi_slam {

const PointKernels& point_kernels_avx512() {
  return kKernels;
}

}  // namespace psi_slam
