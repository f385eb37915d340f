// SPDX-License-Identifier: BSD-3-Clause
// psi-slam LOG: one run from log, or session, to map.
#pragma once

#include <optional>

#include "command_line.h"
#include "interrupt_signals.h"
#include "progress_line.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam_app.h"

namespace psi_slam {

/// Returns the exit code: 2 where the log breaks off, or one that a session holds. Throws UserError.
int map_log(const CommandLine& line, const Streams& streams);

/// Where the recorded run is saved to. Throws UserError, at once, for a file that cannot be, or that is there
/// without --force; a session that is resumed may be replaced by what it becomes.
void check_session_to_save(const CommandLine& line);

/// The settings of a recording under those of the command line; says what of them is no more.
void load_recorded_settings(const CommandLine& line, const std::string& file, const SessionFacts& facts,
                            BoundSettings& bound, const Streams& streams);

/// Shows how far the session is, where somebody sees it, and that it was interrupted.
void watch(MappingSession& session, const InterruptSignals& signals, const CommandLine& line,
           const Streams& streams, std::optional<ProgressLine>& progress_line);

/// Saves the finished session, if it is to be, exports its map, and tells what came of it. Returns the exit
/// code. Where the session cannot be saved, the map is written nevertheless before that is thrown.
int save_and_export(MappingSession& session, const OutputFolder& folder, const CommandLine& line,
                    const Streams& streams, std::optional<ProgressLine>& progress_line);

}  // namespace psi_slam
