// SPDX-License-Identifier: BSD-3-Clause
// The factor Psi, equations 13 and 14: how often the robot has closed loops of late, times how much of its
// path has been spent on going round.
//
//     Psi_k = eta_k * (1/K) sum of C_i over the K frames before k,
//     eta_k = (sum of d_j over all j <= k) / |t'_k - t_0|
//
// The frames of the mean are those on which loop closing ran, the nodes of the pose graph: between them no
// loop could have been closed, and a log with many scans a node would have its mean thinned. The path d_j is
// summed over every scan.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <deque>
#include <optional>

namespace psi_slam {

struct PsiOptions {
  /// Up to here loops are searched exhaustively. Psi is never negative, and the default says: never. The
  /// widest and dearest searches are those of a robot that has found no loop for long, whose Psi is 0; and
  /// there the other matchers find what the exhaustive one finds, in a tenth of its time (psi-slam-bench
  /// match).
  double psi_1 = -1;
  double psi_2 = 1;        ///< from here on by the genetic matcher alone, and by both in between
  int window_frames = 20;  ///< K, >= 1
  double eta_max = 20;     ///< eta grows beyond all bounds where the robot comes back to its start
};

class LoopClosureFactor {
 public:
  explicit LoopClosureFactor(const PsiOptions& options) : options_(options) {}

  /// A scan of the log: the length of odometry's motion since the last one, and where the robot is by the
  /// front end. The first call says where the robot started, t_0.
  void move(double odometry_m, const mrpt::math::TPoint2D& robot);

  struct Value {
    double psi = 0;
    double eta = 0;
    double mean_loops = 0;  ///< the mean of C_i: over what frames there are while they are fewer than K, 0
                            ///< before the first
  };
  /// Of the frame that loop closing runs on next. eta is at most eta_max, and is eta_max where the robot
  /// stands at its very start, whether it has moved yet or not.
  Value value() const;

  /// Loop closing has run on a frame and made this many constraints, C_i.
  void add_frame(int loops);

 private:
  PsiOptions options_;
  std::optional<mrpt::math::TPoint2D> start_;
  double from_start_m_ = 0;
  double path_m_ = 0;
  std::deque<int> loops_;  ///< of the last K frames
};

}  // namespace psi_slam
