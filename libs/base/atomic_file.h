// SPDX-License-Identifier: BSD-3-Clause
// Writes result files completely or not at all: writes them under temporary names and renames them when
// complete. Temporary names contain the writer's process id: ".partial-PID" for folders, ".partial-PID-NAME"
// for files.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace psi_slam {

/// Calls `write(temporary_path)`, then renames that file to `path`. The temporary file is in the same folder,
/// and its name ends like `path`: writers can choose a format by the extension. If `write` throws or writes
/// no file, the temporary file is removed and `path` stays unchanged. Throws SystemFailure that names `path`
/// if it cannot be written.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary_path)>& write);

/// Writes a text, or bytes, to `path` as write_atomically() does.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

/// Writes one or more files whose names `write` chooses. Calls `write(temporary_folder)` with an empty folder
/// within `folder`, then moves every file of the temporary folder to `folder`, sorted by name. Replaces files
/// of the same names. If `write` throws, `folder` stays unchanged and the temporary folder is removed. Throws
/// SystemFailure that names the file or folder that cannot be written.
void write_files_atomically(const std::filesystem::path& folder,
                            const std::function<void(const std::filesystem::path& temporary_folder)>& write);

/// Removes from `folder` the temporary files and folders that are older than an hour and whose writer has
/// ended. Ignores errors.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace psi_slam
