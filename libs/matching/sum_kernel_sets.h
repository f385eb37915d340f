// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "matching/sum_kernel.h"

namespace psi_slam {

// One translation unit each, compiled with that set's flags.
SumKernel sum_kernel_baseline();
SumKernel sum_kernel_avx2();
SumKernel sum_kernel_avx512();

}  // namespace psi_slam
