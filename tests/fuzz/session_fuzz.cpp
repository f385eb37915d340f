// SPDX-License-Identifier: BSD-3-Clause
#include <zstd.h>

#include "base/file_checksum.h"
#include "fuzz_target.h"
#include "session/frame_bytes.h"
#include "session/session_file.h"

namespace {

/// Returns a session with this content and a correct checksum, so that mutated content reaches the reader.
std::string sealed(std::uint32_t version, std::string_view content) {
  using namespace psi_slam;
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 1));
  std::string bytes = "psi-slam session";
  append_number(bytes, version);
  append_number(bytes, std::uint64_t{packed.size()});
  append_number(bytes, std::uint64_t{content.size()});
  bytes += packed;
  return bytes + sha256_of_text(bytes);
}

}  // namespace

/// Reads a session or a journal. Below 8, the first byte is the version of a session whose uncompressed
/// content follows.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  if (size == 0) return 0;
  const std::string_view bytes = fuzz::text_of(data, size);
  fuzz::accept_or_refuse([&] {
    const auto path = data[0] < 8 ? fuzz::file_with("input.session", sealed(data[0], bytes.substr(1)))
                                  : fuzz::file_with("input.session", bytes);
    if (is_session_file(path)) read_session_file(path);
  });
  return 0;
}
