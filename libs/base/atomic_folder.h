// SPDX-License-Identifier: BSD-3-Clause
// For writers that choose the names of their files themselves, or write several at once.
#pragma once

#include <filesystem>
#include <functional>

namespace psi_slam {

/// Calls `write(temporary_folder)`, an empty folder within `folder`; when it returns, moves every file that
/// it left there to `folder`, in the order of their names, in place of those of the same names. If `write`
/// throws, nothing changes in `folder`, and the temporary folder is gone. Throws SystemFailure naming
/// `folder` or the file that cannot be written.
void write_files_atomically(const std::filesystem::path& folder,
                            const std::function<void(const std::filesystem::path& temporary_folder)>& write);

/// Removes what a process that was killed while it wrote left in a folder more than an hour ago, by this and by
/// write_atomically().
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace psi_slam
