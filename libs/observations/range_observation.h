// SPDX-License-Identifier: BSD-3-Clause
// Scans as MRPT's own observation, for its files and tools.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// The scan as MRPT holds scans: n rays evenly spread from the first to the last beam. Beams that are not
/// even (the 180 of GMapping lack the one straight ahead) are put on the coarsest even rays, at most four
/// times as many, that meet each bearing within a milliradian, or else on the finest; rays without a beam,
/// and beams without a return, are invalid. A fan that does not look straight ahead turns the sensor's pose.
mrpt::obs::CObservation2DRangeScan::Ptr range_observation(const Frame& frame);

/// Those of all lasers of the frame, with labels of their own and their own stamps, for a sensory frame: each
/// sensor's pose is seen from where the robot was at the frame's time.
std::vector<mrpt::obs::CObservation2DRangeScan::Ptr> range_observations(const Frame& frame);

}  // namespace psi_slam
