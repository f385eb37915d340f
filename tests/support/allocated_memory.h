// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <malloc.h>

namespace psi_slam {

/// Returns the memory that the program has allocated and not freed. Sanitizers replace this allocation.
inline double allocated_MiB() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd) / (1024 * 1024);
}

}  // namespace psi_slam
