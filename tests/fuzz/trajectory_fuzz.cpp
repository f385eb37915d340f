// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/trajectory_file.h"

#include "fuzz_target.h"

/// Reads a trajectory of any format.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] { read_trajectory(fuzz::file_with("input.tum", fuzz::text_of(data, size))); });
  return 0;
}
