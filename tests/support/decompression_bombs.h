// SPDX-License-Identifier: BSD-3-Clause
// Test helpers for files that decompress to far more than their size.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "sanitizer.h"

namespace psi_slam {

/// Runs `action` and expects that the program needs less than 512 MiB more than before at its peak,
/// or 2 GiB with the sanitizer of threads.
inline void expect_little_memory(const std::function<void()>& action) {
  const auto peak_kb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  const auto before_kb = peak_kb();
  action();
  constexpr long kLimit_kb = (kHasThreadSanitizer ? 4 : 1) * 512 * 1024;
  EXPECT_LT(peak_kb() - before_kb, kLimit_kb);
}

/// Returns a zstd frame of 16 kB for every gigabyte of zeros that it holds.
inline std::string frame_of_zeros(std::uint64_t bytes) {
  std::string frame = "\x28\xB5\x2F\xFD";
  frame += {'\0', '\x38'};  // a window of 128 KiB
  for (std::uint64_t block = 0; block < bytes >> 17; ++block) frame += {'\x02', '\0', '\x10', '\0'};
  return frame + std::string("\x01\0\0", 3);
}

/// Writes a gzip file of `head` and many zeros, about 1 kB for every megabyte.
inline void write_gzipped_zeros(const std::filesystem::path& path, const std::string& head,
                                std::uint64_t zeros) {
  const std::string block(std::size_t{1} << 20, '\0');
  gzFile file = gzopen(path.c_str(), "wb");
  if (file == nullptr || gzwrite(file, head.data(), static_cast<unsigned>(head.size())) < 0)
    throw std::runtime_error("cannot write " + path.string());
  for (std::uint64_t at = 0; at < zeros; at += block.size())
    gzwrite(file, block.data(), static_cast<unsigned>(block.size()));
  if (gzclose(file) != Z_OK) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace psi_slam
