// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>

namespace psi_slam {

/// Returns all bytes of a file. If the file is larger than `most_bytes`, may return only its beginning, which
/// then has more than `most_bytes` bytes, so that the caller notices. Throws
/// std::system_error, whose code says why, if the file cannot be opened, or if reading it fails part-way
/// through.
std::string file_bytes(const std::filesystem::path& path,
                       std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace psi_slam
