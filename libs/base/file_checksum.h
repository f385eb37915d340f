// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace psi_slam {

/// SHA-256 as 64 hexadecimal digits.
std::string sha256_of_text(std::string_view text);

/// The same of a file's bytes, as sha256sum prints it. Throws UserError when it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

/// Of a log, which may be a folder: then of the names and checksums of all files in it, a line each, in the
/// order of the names: "NAME CHECKSUM". Throws as sha256_of_file.
std::string sha256_of_log(const std::filesystem::path& path);

}  // namespace psi_slam
