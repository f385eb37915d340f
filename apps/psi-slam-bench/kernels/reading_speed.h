// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace psi_slam {

/// Returns how many bytes the processor reads in a nanosecond of processor time, again and again in order
/// from memory of this size, with the widest vectors of the machine. The size must be a multiple of 256
/// bytes. Small memory stays in the first cache. The least time of `repeats` measurements counts.
double reading_bytes_per_ns(std::size_t memory_bytes, std::size_t repeats);

}  // namespace psi_slam
