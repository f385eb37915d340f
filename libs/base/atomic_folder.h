// SPDX-License-Identifier: BSD-3-Clause
// Replaces several files of a folder at once: writes all of them to a temporary folder within it, which only
// this process can read, and moves them when all are complete.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace psi_slam {

/// Writes one or more files whose names `write` chooses. Calls `write(temporary_folder)` with an empty folder
/// within `folder`, then moves every file of the temporary folder to `folder`, sorted by name. Replaces files
/// of the same names. Then deletes from `folder` the files that `write` has not written and whose name
/// `is_outdated` accepts.
///
/// If `write` throws, `folder` stays unchanged and the temporary folder is removed. Throws SystemFailure that
/// names the file or folder that cannot be written or deleted, by its final place.
void write_files_atomically(const std::filesystem::path& folder,
                            const std::function<void(const std::filesystem::path& temporary_folder)>& write,
                            const std::function<bool(const std::string& name)>& is_outdated = {});

}  // namespace psi_slam
