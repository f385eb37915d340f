// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "psi_slam/open_log.h"

/// Reads a ROS 2 bag in an MCAP file.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] {
    const auto path = fuzz::file_with("input.mcap", fuzz::text_of(data, size));
    fuzz::read_frames(*open_log(path));
  });
  return 0;
}
