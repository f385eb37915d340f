// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace psi_slam {

/// Returns all bytes of a file. Throws std::system_error, whose code says why, if the file cannot be opened,
/// or if reading it fails part-way through.
std::string file_bytes(const std::filesystem::path& path);

}  // namespace psi_slam
