// SPDX-License-Identifier: BSD-3-Clause
// Where and when a scan was taken, for messages.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Place in the map as text: "(3.1, -2.0) m".
std::string place_text(const mrpt::math::TPoint2D& at);

/// Time of a frame since the first frame of its run, seconds. `later_run_frames` is as in MappingResult.
double time_in_run_s(const std::vector<FrameRecord>& frames, const std::vector<std::size_t>& later_run_frames,
                     std::size_t frame);

}  // namespace psi_slam
