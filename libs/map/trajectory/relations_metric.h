// SPDX-License-Identifier: BSD-3-Clause
// Accuracy of a trajectory: the relations metric of the Freiburg SLAM benchmark.
//
//   R. Kuemmerle et al., "On Measuring the Accuracy of SLAM Algorithms", Autonomous Robots 27(4), 2009: for
//   the true pose d* of time 2 in the frame of time 1 and the trajectory's d = pose1^-1 * pose2, the error is
//   d*^-1 * d. Its length is the translational error, its angle the rotational error. The metric does not
//   depend on the map's frame.
//
// Cartographer's tool uses d * d*^-1 instead. This error has the same angle but another length, which grows
// with |d*| times the angle. RelationsMetric holds both lengths, for comparison with published figures of
// either kind.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <vector>

#include "map/trajectory/trajectory_file.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// True pose of the robot at time 2 in the frame of the robot at time 1.
struct Relation {
  TimeUs time1_us = 0;
  TimeUs time2_us = 0;
  mrpt::math::TPose2D pose1_T_pose2;
};

/// Reads lines `time1 time2 x y z roll pitch yaw` (seconds, metres, radians) and projects them onto the
/// plane. '#' starts a comment. Throws UserError ("file:line: expected ...") on a malformed line, and if the
/// file has no relation.
std::vector<Relation> read_relations(const std::filesystem::path& path);

/// Longest gap between two poses that is interpolated by default, seconds.
inline constexpr double kMaxGap_s = 2.0;

/// The error of one relation.
struct RelationError {
  Relation relation;
  bool interpolated = false;  ///< at least one of the two poses is interpolated
  double translation_m = 0;
  double rotation_deg = 0;
  double cartographer_translation_m = 0;
};

struct ErrorSummary {
  double mean = 0;
  double std = 0;     ///< standard deviation of the population (divided by n)
  double median = 0;  ///< the upper of two middle values
  double p95 = 0;     ///< value at rank floor(0.95 n), counted from 0
  double max = 0;
};

/// Computes the summary of `values`. Throws std::invalid_argument if `values` is empty.
ErrorSummary summarize(std::vector<double> values);

struct RelationsMetric {
  std::size_t exact = 0;         ///< relations with both times in the trajectory
  std::size_t interpolated = 0;  ///< relations with at least one pose interpolated
  std::size_t skipped = 0;       ///< relations with a time outside the trajectory or in a long gap

  ErrorSummary translation_abs_m;
  ErrorSummary translation_sq_m2;
  ErrorSummary rotation_abs_deg;
  ErrorSummary rotation_sq_deg2;
  ErrorSummary cartographer_translation_abs_m;
  ErrorSummary cartographer_translation_sq_m2;

  std::vector<RelationError> errors;  ///< errors of the relations used, in the order of the relations
};

/// Computes the metric over all relations with both times in the trajectory; see pose_at_time(). Sorts the
/// trajectory by time first; poses of equal time keep their order. Throws UserError if no relation can be
/// used, std::invalid_argument if `max_gap_s` is negative or not a number.
RelationsMetric evaluate_relations(Trajectory trajectory, const std::vector<Relation>& relations,
                                   double max_gap_s = kMaxGap_s);

}  // namespace psi_slam
