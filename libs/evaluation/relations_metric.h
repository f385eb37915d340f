// SPDX-License-Identifier: BSD-3-Clause
// How good a trajectory is: the relations metric of the Freiburg SLAM benchmark.
//
//   R. Kuemmerle et al., "On Measuring the Accuracy of SLAM Algorithms", Autonomous Robots 27(4), 2009: for
//   the true pose d* of time 2 seen from time 1 and the trajectory's own d = pose1^-1 * pose2, the error is
//   d*^-1 * d. Its length is the translational error, its angle the rotational one. Averages do not depend on
//   the map's frame.
//
// Cartographer's tool takes d * d*^-1 instead: the same angle, another length (it grows with |d*| times the
// angle). Both are given, so that published figures of either kind can be compared with.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

/// A relation known to be true: where the robot was at time 2, seen from where it was at time 1.
struct Relation {
  TimeUs time1_us = 0;
  TimeUs time2_us = 0;
  mrpt::math::TPose2D pose1_T_pose2;
};

/// Reads `time1 time2 x y z roll pitch yaw` lines (seconds, metres, radians); '#' starts a comment; what
/// leaves the plane is dropped. Throws UserError (file:line, what was expected), also when there is no
/// relation in the file.
std::vector<Relation> read_relations(const std::filesystem::path& path);

struct RelationsMetricOptions {
  double max_gap_s = 2.0;  ///< the longest gap between two poses of the trajectory to interpolate in
};

/// The error of one relation.
struct RelationError {
  Relation relation;
  bool interpolated = false;  ///< one of its poses at least lies between two poses of the trajectory
  double translation_m = 0;
  double rotation_deg = 0;
  double cartographer_translation_m = 0;
};

struct ErrorSummary {
  double mean = 0;
  double std = 0;     ///< of the population: divided by n
  double median = 0;  ///< the upper one of two
  double p95 = 0;     ///< the value at rank floor(0.95 n), from 0
  double max = 0;
};

/// Throws std::invalid_argument when `values` is empty.
ErrorSummary summarize(std::vector<double> values);

struct RelationsMetric {
  std::size_t exact = 0;         ///< relations with both times in the trajectory
  std::size_t interpolated = 0;  ///< relations with at least one pose interpolated
  std::size_t skipped = 0;       ///< relations with a time outside the trajectory or in a gap too long

  ErrorSummary translation_abs_m;
  ErrorSummary translation_sq_m2;
  ErrorSummary rotation_abs_deg;
  ErrorSummary rotation_sq_deg2;
  ErrorSummary cartographer_translation_abs_m;
  ErrorSummary cartographer_translation_sq_m2;

  std::vector<RelationError> errors;  ///< of the relations used, in the order given
};

/// The metric over all relations that the trajectory can answer. The trajectory is sorted by time first
/// (poses of one time keep their order). A pose within 0.1 ms of a relation's time is taken as it is, since
/// relations are printed with as few as five decimals; otherwise it is interpolated linearly, the angle along
/// the shorter arc. Throws UserError when no relation can be answered, naming both spans of time;
/// std::invalid_argument when the gap is negative or no number.
RelationsMetric evaluate_relations(Trajectory trajectory, const std::vector<Relation>& relations,
                                   const RelationsMetricOptions& options = {});

}  // namespace psi_slam
