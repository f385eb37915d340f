// SPDX-License-Identifier: BSD-3-Clause
// Test helper that compresses by zstd.
#pragma once

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace psi_slam {

/// Returns the bytes as a zstd frame. `block_bytes` above 0 ends a block of the frame after so many bytes,
/// and leaves out the size of the content, as programs do that compress while they record.
inline std::string zstd_frame(const std::string& bytes, std::size_t block_bytes = 0) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  std::string frame;
  std::string room(ZSTD_CStreamOutSize(), '\0');
  const std::size_t step = block_bytes > 0 ? block_bytes : std::max<std::size_t>(bytes.size(), 1);
  for (std::size_t at = 0;; at += step) {
    const bool is_last = at + step >= bytes.size();
    ZSTD_inBuffer in{bytes.data() + at, std::min(step, bytes.size() - at), 0};
    std::size_t left = 0;
    do {
      ZSTD_outBuffer out{room.data(), room.size(), 0};
      left = ZSTD_compressStream2(context.get(), &out, &in, is_last ? ZSTD_e_end : ZSTD_e_flush);
      if (ZSTD_isError(left) != 0) throw std::runtime_error(ZSTD_getErrorName(left));
      frame.append(room, 0, out.pos);
    } while (left > 0);
    if (is_last) return frame;
  }
}

}  // namespace psi_slam
