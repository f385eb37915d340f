// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/ini_file.h"
#include "fuzz_target.h"

/// Parses a settings file. Included files do not exist.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] { parse_ini(fuzz::text_of(data, size), fuzz::folder() / "input.ini"); });
  return 0;
}
