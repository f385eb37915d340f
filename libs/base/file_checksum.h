// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace psi_slam {

/// SHA-256 of a text, as 64 hexadecimal digits.
std::string sha256_of_text(std::string_view text);

/// SHA-256 of a file, as sha256sum prints it. Throws UserError if the file is not readable.
std::string sha256_of_file(const std::filesystem::path& path);

/// SHA-256 of a log. For a folder: SHA-256 of a text with a line "NAME CHECKSUM" for each file, sorted by
/// name. Throws UserError if a file is not readable.
std::string sha256_of_log(const std::filesystem::path& path);

}  // namespace psi_slam
