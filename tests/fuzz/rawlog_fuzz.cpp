// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "psi_slam/open_log.h"

/// Reads a rawlog of MRPT.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] {
    const auto path = fuzz::file_with("input.rawlog", fuzz::text_of(data, size));
    fuzz::read_frames(*open_log(path));
  });
  return 0;
}
