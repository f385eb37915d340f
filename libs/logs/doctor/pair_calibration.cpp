// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/pair_calibration.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <utility>

#include "base/significance.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr std::size_t kMostPairs = 500;
const double kHeadingDeterminedTo_rad = DEG2RAD(0.5);
constexpr int kRoundsOfTurned = 2;  // each begins with better guesses of the motions of the scans

/// Motions of the robot and the mount of the laser, which give the guesses for the alignment.
struct Guess {
  std::vector<FrameMark> marks;
  TPose2D robot_T_laser;
};

bool is_turned(const std::optional<LaserMountEstimate>& mount, const TPose2D& stated_mount) {
  return mount && mount->deviation_rad < kHeadingDeterminedTo_rad &&
         std::abs(wrapToPi(mount->robot_T_laser.phi - stated_mount.phi)) > kOtherDirection_rad;
}

/// Returns the mount that a turned laser may have; empty if the stated heading may be right.
std::optional<TPose2D> turned_mount(const OdometryAgreement& odometry,
                                    const std::optional<LaserMountEstimate>& mount,
                                    const TPose2D& stated_mount) {
  if (!follows_its_heading(odometry)) return std::nullopt;  // the headings of odometry may be wrong instead
  if (moves_in_another_direction(odometry))
    return TPose2D{stated_mount.x, stated_mount.y,
                   wrapToPi(stated_mount.phi - odometry.direction_offset_rad)};
  if (!is_turned(mount, stated_mount)) return std::nullopt;
  return mount->robot_T_laser;
}

class PairCalibrator {
 public:
  PairCalibrator(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                 ScanLibrary& library)
      : marks_(marks), pairs_(pairs), library_(library) {}

  PairCalibration estimate(const Guess& guess, const ShareObserver& progress = {}) {
    library_.set_mount(guess.robot_T_laser);
    std::vector<AlignedPair> aligned = align_pairs(guess.marks, pairs_, library_, progress);
    PairCalibration found;
    found.delay = remove_scan_delay(aligned, marks_);
    found.mount = estimate_laser_mount(aligned, guess.robot_T_laser);
    return found;
  }

  /// Returns the guess that follows from estimates with the mount `robot_T_laser`. Corrects only what is
  /// significant. Empty if nothing is.
  std::optional<Guess> improved(const PairCalibration& found, const TPose2D& robot_T_laser) const {
    Guess guess{marks_, robot_T_laser};
    const bool is_delayed = found.delay && found.delay->is_significant();
    if (is_delayed) guess.marks = with_scan_delay(marks_, found.delay->delay_s);
    if (!found.mount) return is_delayed ? std::optional(guess) : std::nullopt;
    const LaserMountEstimate& mount = *found.mount;
    const TPose2D off = between(robot_T_laser, mount.robot_T_laser);
    const bool is_elsewhere = off.norm() > kSignificantDeviations * mount.deviation_m ||
                              std::abs(off.phi) > kSignificantDeviations * mount.deviation_rad;
    const bool is_scaled =
        std::abs(mount.odometry_scale - 1) > kSignificantDeviations * mount.scale_deviation;
    if (is_elsewhere) guess.robot_T_laser = mount.robot_T_laser;
    for (FrameMark& mark : guess.marks) {
      if (!is_scaled) break;
      mark.odom_T_robot.x /= mount.odometry_scale;
      mark.odom_T_robot.y /= mount.odometry_scale;
    }
    return is_delayed || is_elsewhere || is_scaled ? std::optional(guess) : std::nullopt;
  }

  /// Estimates again under the assumption that the laser has about the mount `robot_T_laser`. Empty if the
  /// laser does not prove to be turned.
  std::optional<PairCalibration> estimate_turned(const std::vector<FrameMark>& marks, TPose2D robot_T_laser,
                                                 const TPose2D& stated_mount) {
    PairCalibration found;
    Guess guess{marks, robot_T_laser};
    for (int round = 0; round < kRoundsOfTurned; ++round) {
      found = estimate(guess);
      if (!is_turned(found.mount, stated_mount)) return std::nullopt;
      guess.robot_T_laser = found.mount->robot_T_laser;
    }
    found.laser_is_turned = true;
    return found;
  }

 private:
  const std::vector<FrameMark>& marks_;
  const std::vector<FramePair>& pairs_;
  ScanLibrary& library_;
};

}  // namespace

std::vector<FramePair> calibration_pairs(const std::vector<FrameMark>& marks) {
  return overlapping_pairs(marks, kComparedMotion_m, kComparedTurn_rad, kMostPairs);
}

PairCalibration calibrate_by_pairs(const OdometryAgreement& odometry, const std::vector<FrameMark>& marks,
                                   const std::vector<FrameMark>& corrected, const TPose2D& stated_mount,
                                   const std::vector<FramePair>& pairs, ScanLibrary& library,
                                   const ShareObserver& progress) {
  PairCalibrator calibrator(marks, pairs, library);
  PairCalibration found = calibrator.estimate({corrected, stated_mount}, part_of(progress, 0, 0.5));
  if (const auto mount = turned_mount(odometry, found.mount, stated_mount)) {
    if (auto turned = calibrator.estimate_turned(corrected, *mount, stated_mount)) found = std::move(*turned);
  }
  const TPose2D mount = found.laser_is_turned ? found.mount->robot_T_laser : stated_mount;
  if (const auto guess = calibrator.improved(found, mount)) {
    const bool is_turned = found.laser_is_turned;
    found = calibrator.estimate(*guess, part_of(progress, 0.5, 1));
    found.laser_is_turned = is_turned && found.mount;
  }
  if (progress) progress(1);
  library.set_mount(found.laser_is_turned ? found.mount->robot_T_laser : stated_mount);
  return found;
}

}  // namespace psi_slam
