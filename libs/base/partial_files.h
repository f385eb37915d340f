// SPDX-License-Identifier: BSD-3-Clause
// Temporary names of files and folders that are being written, and what all writers of files share. A
// temporary name contains the process id of its writer and a random number: ".partial-PID-RANDOM" for
// folders, ".partial-PID-RANDOM-NAME" for files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/descriptor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Returns a new temporary name that nobody can predict. `name` is empty for a folder. The result ends like
/// `name`, of which it drops the beginning if it is long.
std::string new_partial_name(const std::string& name = {});

/// Returns whether a name is one of new_partial_name().
bool is_partial_name(std::string_view name);

/// Returns the folder that holds the entry of a file.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// Returns the exception for a file that cannot be written for a reason of the system, such as ENOSPC.
SystemFailure cannot_write(const std::filesystem::path& path, int error_number);

/// Returns the exception for a file that cannot be created. For a folder that is missing or not writable, it
/// says what to do.
SystemFailure cannot_create(const std::filesystem::path& path, int error_number);

/// Waits until the disk holds an open file or the entries of an open folder. A power failure cannot undo it
/// then. Throws SystemFailure that names `path`.
void wait_for_disk(const Descriptor& written, const std::filesystem::path& path);

/// Waits until the disk holds a file or the entries of a folder. Does nothing without permission to read it.
/// Throws SystemFailure that names `path`.
void wait_for_disk(const std::filesystem::path& written, const std::filesystem::path& path);

/// Removes from `folder` the temporary files and folders that are older than an hour and whose writer has
/// ended. Ignores errors.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace psi_slam
