// SPDX-License-Identifier: BSD-3-Clause
// The commands of psi-slam that read logs. Each returns the exit code and throws UserError for invalid input.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "command_line.h"
#include "interrupt_signals.h"
#include "map/exports/run_summary.h"
#include "map/report/output_folder.h"
#include "progress_line.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam_app.h"
#include "session/session_input.h"
#include "session/session_recording.h"

namespace psi_slam {

/// psi-slam LOG: maps a log or resumes a session. The exit code is 2 if one of the logs is damaged.
int map_log(const CommandLine& line, const Streams& streams);

/// psi-slam live: maps what a driving robot sends, until it ends or the user interrupts. The exit code is 2
/// if reading failed on the way.
int map_live(const CommandLine& line, const Streams& streams);

/// Localizes in the map `line.map` at the scans of a live source, beginning at `start` if it is known.
int localize_live(const CommandLine& line, const LiveInput& source, const Settings& settings,
                  const std::optional<mrpt::math::TPose2D>& start, const Streams& streams);

/// psi-slam merge: makes one map of several runs. Writes nothing if a run is unreadable or cannot be placed.
int merge_runs(const CommandLine& line, const Streams& streams);

/// psi-slam localize: finds and tracks a robot in a finished map, by a log or while it drives. The exit code
/// is 0 if the robot is localized at the end of the log, 1 if it is not, 2 if the log is damaged.
int localize(const CommandLine& line, const Streams& streams);

/// psi-slam diff: compares the walls of two maps. The exit code is 0 if no wall has changed, 1 if one has.
int compare_maps(const CommandLine& line, const Streams& streams);

/// psi-slam check: prints what the log holds and what looks wrong, as sentences or as JSON. The exit code is
/// 2 if damage ends the log early.
int check_log(const CommandLine& line, const Streams& streams);

/// psi-slam eval: compares a trajectory with known relative poses, by the metric of relations_metric.h.
int evaluate_path(const CommandLine& line, const Streams& streams);

/// psi-slam play: plays a log as a ROS 2 robot. The exit code is 2 if the log is damaged.
int play_log(const CommandLine& line, const Streams& streams);

/// psi-slam options: explains the options of the settings files, all of them or those that are asked for.
int explain_options(const CommandLine& line, const Streams& streams);

// Steps that several commands share.

/// Warns of a journal whose last chunk is incomplete.
void warn_of_lost_end(const SessionRecording& recording, const Streams& streams);

/// Loads the settings of a recorded session into `bound`. Prints a warning for each obsolete option. Also
/// warns, unless --quiet is given, if another version of the program recorded the session.
void load_recorded_settings(const CommandLine& line, const std::string& file, const SessionFacts& facts,
                            BoundSettings& bound, const Streams& streams);

/// Reads the session of --resume. Loads its settings into `bound` as load_recorded_settings() does, and then
/// those of the command line. Throws UserError if these change the map of the session.
std::shared_ptr<const SessionRecording> read_resumed(const CommandLine& line, BoundSettings& bound,
                                                     const Streams& streams);

/// Calibrates the log of `input` if log.calibrate is true. Shows the progress on a terminal, unless --quiet
/// is given. Throws SystemFailure after an interrupt.
void calibrate(SessionInput& input, const Settings& settings, const CommandLine& line,
               const InterruptSignals& signals, const Streams& streams);

/// Sets an observer of `session` that shows the progress on a terminal, unless --quiet is given, and prints a
/// message after an interrupt. The observer keeps references to all arguments.
void watch(MappingSession& session, const InterruptSignals& signals, const CommandLine& line,
           const Streams& streams, std::optional<ProgressLine>& progress_line);

/// Saves the finished session if --save-session is given, writes its results, deletes the journal, and prints
/// the summary and all warnings. Returns the exit code. If the session cannot be saved, the results are
/// written before the exception is thrown. Calls `exported`, unless it is empty, when the results are
/// written.
int save_and_export(MappingSession& session, const OutputFolder& folder, const CommandLine& line,
                    const Streams& streams, std::optional<ProgressLine>& progress_line,
                    const std::function<void(const RunSummary&)>& exported = {});

}  // namespace psi_slam
