// SPDX-License-Identifier: BSD-3-Clause
// Compression and decompression of bytes in memory, and their checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace psi_slam {

/// Decompresses data to exactly `size` bytes. `name` is the compression: "bz2", "lz4" (frames) or "zstd".
/// Allocates memory as bytes are decompressed, not `size` bytes at once, because `size` may be wrong. Throws
/// MalformedBytes for any other compression, for damaged data, and for data of another size.
std::string decompress(std::string_view name, std::string_view compressed, std::uint64_t size);

/// Decompresses a zstd frame, with or without a stated size, to at most `most` bytes. Throws MalformedBytes
/// if the frame is damaged or holds more bytes.
std::string decompress_zstd_frame(std::string_view compressed, std::uint64_t most);

/// Returns `count` bytes as the contents of a gzip file, without name and time in the header. Throws
/// SystemFailure if memory runs out.
std::string gzipped(const void* bytes, std::size_t count);

/// Returns bytes as one zstd frame of a fast level, which states their number. Throws SystemFailure if memory
/// runs out.
std::string zstd_compressed(std::string_view bytes);

/// Returns the CRC-32 of bytes (ISO 3309), as gzip, PNG and MCAP define it.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace psi_slam
