// SPDX-License-Identifier: BSD-3-Clause
// Prepares the scans of a robot that stands still for long for drawing. Such a robot takes the same scan
// thousands of times. Without preparation, a person who stands in view for minutes would outvote all scans
// that see the floor there later.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Consecutive frames [begin, end) of a robot that stands still.
struct StandingSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Finds the spans of at least 50 frames and ten seconds in which the robot stays within 2 cm and 0.5 degrees
/// of its first pose. Frames more than five seconds apart do not belong to one span.
std::vector<StandingSpan> standing_spans(const std::vector<Frame>& log,
                                         const std::vector<mrpt::math::TPose2D>& map_T_robot);

/// A frame to draw at the pose of the frame with number `index`.
struct StandingView {
  Frame frame;
  std::size_t index = 0;
};

/// Returns at most 64 frames that represent a span, evenly spread in time. The frame with ranges before it
/// represents a frame whose ranges were discarded. Readings of things that came or left are invalid: in at
/// least an eighth of the frames, the same beam sees at least 0.3 m and 5 % farther.
std::vector<StandingView> standing_views(const std::vector<Frame>& log, const StandingSpan& span);

}  // namespace psi_slam
