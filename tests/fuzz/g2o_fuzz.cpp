// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/g2o_file.h"

#include "fuzz_target.h"

/// Reads a pose graph in a g2o file.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] { read_pose_graph(fuzz::file_with("input.g2o", fuzz::text_of(data, size))); });
  return 0;
}
