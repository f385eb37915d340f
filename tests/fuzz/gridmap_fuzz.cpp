// SPDX-License-Identifier: BSD-3-Clause
#include "localization/reference_map.h"

#include "fuzz_target.h"

/// Reads a grid map of MRPT.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] { read_map_file(fuzz::file_with("input.gridmap", fuzz::text_of(data, size))); });
  return 0;
}
