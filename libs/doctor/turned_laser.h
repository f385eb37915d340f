// SPDX-License-Identifier: BSD-3-Clause
// Finds a laser that is mounted in another direction than the log states: backwards, for example. Its scans
// then move in another direction than odometry, whose motions are no good guesses for their alignment.
#pragma once

#include <optional>
#include <vector>

#include "doctor/odometry_check.h"
#include "doctor/pair_alignment.h"

namespace psi_slam {

/// Returns the mount of a laser whose heading differs from that of `stated_mount` by more than 15 degrees, by
/// the directions of motion in `odometry` or by the pairs, which were aligned with the scans of `library`.
/// Gives these scans that mount and aligns the pairs again. Otherwise, and if odometry moves across its own
/// headings, which may then be wrong instead, returns nothing and changes nothing.
std::optional<LaserMountEstimate> find_turned_mount(const OdometryAgreement& odometry,
                                                    const std::vector<FrameMark>& marks,
                                                    const mrpt::math::TPose2D& stated_mount,
                                                    std::vector<AlignedPair>& pairs, ScanLibrary& library);

}  // namespace psi_slam
