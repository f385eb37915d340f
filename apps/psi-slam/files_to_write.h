// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "command_line.h"

namespace psi_slam {

/// Checks the session, the journal and the output folder that the arguments name, before any work. Throws
/// UserError if the session or the journal cannot be written or exists, unless --force is given, and if one
/// output would replace another or an input.
void check_files_to_write(const CommandLine& line);

/// Returns the name of a run: that of its log or session, without extension.
std::string run_name(const CommandLine& line);

/// Returns the folder for the results of a command line without -o, in the current folder: NAME-map for a log
/// or session NAME.log, or NAME-map-2 and so on if that exists and --force is not given.
std::filesystem::path default_output_folder(const CommandLine& line);

}  // namespace psi_slam
