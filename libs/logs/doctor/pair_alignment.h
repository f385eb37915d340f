// SPDX-License-Identifier: BSD-3-Clause
// Compares odometry with the alignment of single pairs of scans: lost reversals, jumps, corrected odometry
// and the mount of the laser.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "base/share_observer.h"
#include "logs/doctor/log_facts.h"
#include "logs/doctor/scan_delay.h"
#include "logs/doctor/scan_sampling.h"
#include "logs/frames/scan_alignment.h"

namespace psi_slam {

/// Motion between two frames by odometry and by their scans.
struct AlignedPair {
  FramePair frames;
  mrpt::math::TPose2D by_odometry;
  ScanAlignment by_scans;  ///< aligned with odometry's motion as the guess
};

/// Aligns all pairs whose scans have the same span. The result includes unreliable alignments.
std::vector<AlignedPair> align_pairs(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                     const ScanLibrary& library, const ShareObserver& progress = {});

/// Returns the turns of the reliably aligned pairs.
std::vector<ScanTurn> reliable_turns(const std::vector<AlignedPair>& pairs);

/// Estimates the delay of the scans from the pairs, see estimate_scan_delay(). Replaces the motions by
/// odometry of all pairs with those by `marks`; if the delay is significant, between the times at which the
/// scans were measured.
std::optional<ScanDelay> remove_scan_delay(std::vector<AlignedPair>& pairs,
                                           const std::vector<FrameMark>& marks);

/// Odometry that counts reversing as driving forwards: the scans move backwards by about as much as odometry
/// moves forwards.
struct LostReversals {
  double checked_m = 0;          ///< distance by odometry over all pairs whose motion the scans determine
  std::vector<FramePair> pairs;  ///< pairs with a reversed motion according to the scans
  double reversed_m = 0;         ///< distance by scans over the reversed pairs
};

/// Aligns every pair that moves by 0.12 to 0.8 m again, with the opposite translation and the same turn as
/// the guess. A pair counts as reversed if both alignments move backwards, or if the second alignment does
/// and is clearly better.
LostReversals find_lost_reversals(const std::vector<AlignedPair>& pairs, const ScanLibrary& library);

/// Pose of the laser on the robot that best explains the motions of scans and odometry (hand-eye
/// calibration).
struct LaserMountEstimate {
  std::size_t pairs = 0;
  mrpt::math::TPose2D robot_T_laser;
  double deviation_m = 0;       ///< standard deviation of x or y, whichever is larger
  double deviation_rad = 0;     ///< standard deviation of the heading
  double odometry_scale = 1.0;  ///< distance by odometry divided by distance by scans
  double scale_deviation = 0;   ///< standard deviation of odometry_scale
};

/// Estimates the mount from pairs of scans that were read with the mount `stated_mount`. Empty for fewer than
/// 40 reliably aligned pairs whose motion the scans determine. The standard deviations follow from the
/// residuals. They are large, up to 1 m, 1 rad and 1, for what the motion does not determine: the position
/// without turns, heading and scale without straight motion.
std::optional<LaserMountEstimate> estimate_laser_mount(const std::vector<AlignedPair>& pairs,
                                                       const mrpt::math::TPose2D& stated_mount);

/// Returns pairs of consecutive frames between which odometry moves faster than a robot: above 3 m/s and 0.4
/// m, or above 150 degrees/s and 30 degrees. At most `most` pairs, largest motion first. The time between two
/// frames counts as at least the median period, since time stamps may run backwards.
std::vector<FramePair> suspected_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                       std::size_t most);

struct OdometryJumps {
  std::vector<FramePair> pairs;  ///< pairs whose scans moved by less than half of odometry's motion
  double largest_m = 0;
  double largest_turn_rad = 0;
};

OdometryJumps confirm_jumps(const std::vector<FrameMark>& marks, const std::vector<FramePair>& suspects,
                            const ScanLibrary& library);

/// Agreement of odometry with the scans at revisited places. If it is very good, a mapper has corrected the
/// odometry, because the drift of wheel odometry would show here.
struct RevisitAgreement {
  std::size_t revisits = 0;    ///< pairs at one place by odometry, but far apart along the path
  std::size_t agreeing = 0;    ///< revisits that the scans confirm to 5 cm and 1 degree
  double median_offset_m = 0;  ///< median offset of odometry from the scans at the agreeing revisits
};

RevisitAgreement check_revisits(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                const ScanLibrary& library);

}  // namespace psi_slam
