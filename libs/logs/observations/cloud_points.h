// SPDX-License-Identifier: BSD-3-Clause
// Points of MRPT's observations of 3D sensors.
#pragma once

#include <mrpt/math/TPoint3D.h>
#include <mrpt/obs/CObservation.h>

#include <string>
#include <vector>

namespace psi_slam {

/// Returns whether an observation is one of a 3D sensor: CObservation3DRangeScan, CObservationPointCloud,
/// CObservationRotatingScan or CObservationVelodyneScan.
bool is_cloud(const mrpt::obs::CObservation& observation);

/// Returns the points of an observation of a 3D sensor, metres in the sensor's frame. Loads parts that are
/// stored in other files. Throws UserError that starts with `place` if MRPT finds parts missing or damaged,
/// and for a CObservationRotatingScan of several rows, which does not state their elevations.
std::vector<mrpt::math::TPoint3Df> cloud_points(const mrpt::obs::CObservation& observation,
                                                const std::string& place);

}  // namespace psi_slam
