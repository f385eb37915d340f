// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "localization/reference_map.h"

/// Reads map.yaml and its image map.pgm. The image follows the first byte 0 of the input.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  const std::string_view bytes = fuzz::text_of(data, size);
  const std::size_t end = std::min(bytes.find('\0'), bytes.size());
  fuzz::accept_or_refuse([&] {
    fuzz::file_with("map.pgm", bytes.substr(std::min(end + 1, bytes.size())));
    read_map_file(fuzz::file_with("map.yaml", bytes.substr(0, end)));
  });
  return 0;
}
