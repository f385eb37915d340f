// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/turned_laser.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

const double kHeadingDeterminedTo_rad = DEG2RAD(0.5);
constexpr int kRounds = 2;  // each begins with better guesses of the motions of the scans

bool is_turned(const std::optional<LaserMountEstimate>& mount, const TPose2D& stated_mount) {
  return mount && mount->deviation_rad < kHeadingDeterminedTo_rad &&
         std::abs(wrapToPi(mount->robot_T_laser.phi - stated_mount.phi)) > kOtherDirection_rad;
}

/// Returns a guess of the mount; empty if the stated heading may be right.
std::optional<TPose2D> guess_of(const OdometryAgreement& odometry, const std::vector<AlignedPair>& pairs,
                                const TPose2D& stated_mount) {
  if (!follows_its_heading(odometry)) return std::nullopt;  // the headings of odometry may be wrong instead
  if (moves_in_another_direction(odometry))
    return TPose2D{stated_mount.x, stated_mount.y,
                   wrapToPi(stated_mount.phi - odometry.direction_offset_rad)};
  const auto estimate = estimate_laser_mount(pairs, stated_mount);
  if (!is_turned(estimate, stated_mount)) return std::nullopt;
  return estimate->robot_T_laser;
}

}  // namespace

std::optional<LaserMountEstimate> find_turned_mount(const OdometryAgreement& odometry,
                                                    const std::vector<FrameMark>& marks,
                                                    const TPose2D& stated_mount,
                                                    std::vector<AlignedPair>& pairs, ScanLibrary& library) {
  std::optional<TPose2D> mount = guess_of(odometry, pairs, stated_mount);
  if (!mount) return std::nullopt;
  std::vector<FramePair> frames;
  for (const AlignedPair& pair : pairs) frames.push_back(pair.frames);
  std::optional<LaserMountEstimate> estimate;
  for (int round = 0; round < kRounds; ++round) {
    library.set_mount(*mount);
    estimate = estimate_laser_mount(align_pairs(marks, frames, library), *mount);
    if (!is_turned(estimate, stated_mount)) {
      library.set_mount(stated_mount);
      return std::nullopt;
    }
    mount = estimate->robot_T_laser;
  }
  library.set_mount(*mount);
  pairs = align_pairs(marks, frames, library);
  return estimate;
}

}  // namespace psi_slam
