// SPDX-License-Identifier: BSD-3-Clause
// Estimates what a log lacks or states wrongly from pairs of its scans: the delay of the scans, the scale of
// odometry and the pose of the laser on the robot. psi-slam check, the checks at the end of a run and
// log.calibrate all use this estimator.
#pragma once

#include <optional>
#include <vector>

#include "base/share_observer.h"
#include "logs/doctor/odometry_check.h"
#include "logs/doctor/pair_alignment.h"

namespace psi_slam {

struct PairCalibration {
  std::optional<ScanDelay> delay;
  std::optional<LaserMountEstimate> mount;  ///< by odometry without the delay if that is significant
  /// The heading of `mount` differs by more than kOtherDirection_rad from the stated one, which is wrong: the
  /// laser looks backwards, for example.
  bool laser_is_turned = false;
};

/// Returns the pairs that calibrate_by_pairs() compares, at most 500.
std::vector<FramePair> calibration_pairs(const std::vector<FrameMark>& marks);

/// Estimates from the scans of `library`, which were read with the mount `stated_mount`. The motions by
/// `corrected`, odometry that agrees with the scans (see check_odometry_and_delay()), are the first guesses
/// for the alignment. Alignments stay near their guesses, so all pairs are aligned again with what the first
/// estimates correct. The laser counts as turned if directions of motion or pairs say so, unless odometry
/// moves across its own headings, which may then be wrong instead. Gives the scans the estimated mount of a
/// turned laser, and `stated_mount` otherwise.
PairCalibration calibrate_by_pairs(const OdometryAgreement& odometry, const std::vector<FrameMark>& marks,
                                   const std::vector<FrameMark>& corrected,
                                   const mrpt::math::TPose2D& stated_mount,
                                   const std::vector<FramePair>& pairs, ScanLibrary& library,
                                   const ShareObserver& progress = {});

}  // namespace psi_slam
