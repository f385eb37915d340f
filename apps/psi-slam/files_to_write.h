// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command_line.h"

namespace psi_slam {

/// Checks the session, the journal and the output folder that the arguments name, before any work. Throws
/// UserError if the session or the journal cannot be written or exists, unless --force is given, and if one
/// output would replace another or an input.
void check_files_to_write(const CommandLine& line);

}  // namespace psi_slam
