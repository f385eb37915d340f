// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace psi_slam {

/// Whether `decompress` knows a compression of that name: "bz2", "lz4" (frames) or "zstd".
bool is_known_compression(std::string_view name);

/// Decompresses to exactly `size` bytes. Memory grows with what comes out, never ahead with what `size`
/// claims. Throws MalformedBytes when the data are damaged, too few or too many.
std::string decompress(std::string_view name, std::string_view compressed, std::uint64_t size);

/// Whether the bytes begin like a frame of zstd.
bool is_zstd(std::string_view bytes);

/// Decompresses a frame of zstd that states its size or not, up to `most` bytes.
std::string decompress_zstd_frame(std::string_view compressed, std::uint64_t most);

}  // namespace psi_slam
