// SPDX-License-Identifier: BSD-3-Clause
// Tables of a run as comma-separated values (RFC 4180) with a header line. Lengths are metres, angles
// radians, times seconds unless the column's name says otherwise.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns a text as one field, quoted if necessary.
std::string csv_field(const std::string& text);

/// Returns frames.csv: one row per scan in the order of the log, with its poses, match, loop closure factor
/// Psi, loops and times. `node` and `matcher` may be empty. `matched` is 1 if the scan matched a local map
/// and 0 if not. For the first scan of a run, which has no local map to match with, `matched` is empty.
/// `matcher` is the matcher that was chosen. `searched_loops` is 1 if the scan searched for loops. The last
/// columns have the number of searches of each kind that it ran, such as `branch_and_bound_searches`; see
/// SearchKind.
std::string frames_csv(const std::vector<FrameRecord>& frames);

/// Returns the covariance of (x, y, theta) of each scan's pose in the axes of the map: m^2, m rad, rad^2. It
/// is that of the scan's node, or of the last node before it, relative to the first scan, and accounts for
/// shared errors; see placed_covariances(). Empty if the place of the node in the map is unknown.
std::vector<std::optional<Eigen::Matrix3d>> frame_covariances(const MappingResult& result);

/// Returns trajectory.csv: one row per scan in the order of the log, with its time, its pose in the map and
/// its covariance by frame_covariances(), with empty fields if there is none. `run` is the number of the log
/// as in logs_of(), counted from 1 as in the names of the files trajectory-1.tum, ...
std::string trajectory_csv(const MappingResult& result);

/// Returns loops.csv: one row per attempt to close a loop in the order of the records, with its match,
/// state and the reason of its rejection. `reason` is empty for loops that are not rejected. `matcher` is the
/// matcher that was chosen, and `search` the search that it ran.
std::string loops_csv(const std::vector<LoopRecord>& loops);

}  // namespace psi_slam
