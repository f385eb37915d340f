// SPDX-License-Identifier: BSD-3-Clause
// psi-slam merge: several drives through one building, one map.
#pragma once

#include "command_line.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Returns the exit code. Throws UserError, with nothing written, when a drive cannot be read or placed.
int merge_runs(const CommandLine& line, const Streams& streams);

}  // namespace psi_slam
