// SPDX-License-Identifier: BSD-3-Clause
// The report's plots over time, as SVG.
#pragma once

#include <string>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// The front end's response over the log's time: mean and extremes of each stretch, and when loops were
/// closed.
std::string response_plot(const MappingResult& result);

/// The factor Psi over the log's time, logarithmic, with its thresholds; below it, by which matcher loops
/// were searched.
std::string psi_plot(const MappingResult& result);

/// Which colour of that strip is which matcher, of those that were used.
std::string psi_key(const MappingResult& result);

/// How long the loops of each node took to match over the log's time, logarithmic.
std::string loop_matching_plot(const MappingResult& result);

/// The work for each scan over the log's time, logarithmic, with the time between two scans as a line.
std::string work_plot(const MappingResult& result);

}  // namespace psi_slam
