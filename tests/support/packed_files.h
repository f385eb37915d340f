// SPDX-License-Identifier: BSD-3-Clause
// Test helper that compresses bytes as the usual programs do.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <lzma.h>

#include <stdexcept>
#include <string>

#include "zstd_files.h"

namespace psi_slam {

/// Returns the bytes as a file of a compression: "bz2", "lz4", "xz" or "zstd". lz4 and zstd have check sums,
/// as files of their programs.
inline std::string packed_as(const std::string& compression, std::string bytes) {
  if (compression == "zstd") {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
    packed.resize(ZSTD_compress2(context.get(), packed.data(), packed.size(), bytes.data(), bytes.size()));
    return packed;
  }
  if (compression == "lz4") {
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    std::string packed(LZ4F_compressFrameBound(bytes.size(), &preferences), '\0');
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &preferences));
    return packed;
  }
  std::string packed(bytes.size() + bytes.size() / 50 + 1000, '\0');
  if (compression == "bz2") {
    constexpr int kBlock_100kB = 9;
    auto size = static_cast<unsigned>(packed.size());
    if (BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()),
                                 kBlock_100kB, 0, 0) != BZ_OK)
      throw std::runtime_error("bzip2 fails");
    packed.resize(size);
    return packed;
  }
  std::size_t size = 0;
  if (lzma_easy_buffer_encode(
          LZMA_PRESET_DEFAULT, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const std::uint8_t*>(bytes.data()),
          bytes.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &size, packed.size()) != LZMA_OK)
    throw std::runtime_error("xz fails");
  packed.resize(size);
  return packed;
}

}  // namespace psi_slam
