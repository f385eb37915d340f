// SPDX-License-Identifier: BSD-3-Clause
// The factor Psi, equations 13 and 14: the recent rate of closed loops times the ratio of travelled path to
// distance from the start.
//
//     Psi_k = eta_k * (1/K) sum of C_i over the K frames before k,
//     eta_k = (sum of d_j over all j <= k) / |t'_k - t_0|
//
// The mean is over nodes of the pose graph, the frames at which loop closing runs. Over all frames it would
// depend on the number of scans per node. The path d_j is summed over every scan.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <deque>
#include <optional>

namespace psi_slam {

struct PsiOptions {
  /// Loops are searched exhaustively for Psi <= psi_1. Psi is never negative, so the default never does. The
  /// widest searches are those of a robot without loops for a long time, with Psi 0. There the other matchers
  /// find the same in a tenth of the time (psi-slam-bench match).
  double psi_1 = -1;
  double psi_2 = 1;        ///< genetic matcher for Psi >= psi_2, both matchers in between
  int window_frames = 20;  ///< K, >= 1
  double eta_max = 20;     ///< bound of eta, which is infinite at the start
};

class LoopClosureFactor {
 public:
  explicit LoopClosureFactor(const PsiOptions& options) : options_(options) {}

  /// Call for every scan: the length of odometry's motion since the last scan, and the robot's position by
  /// the front end. The first position is t_0.
  void move(double odometry_m, const mrpt::math::TPoint2D& robot);

  struct Value {
    double psi = 0;
    double eta = 0;
    double mean_loops = 0;  ///< mean of C_i over at most K frames; 0 before the first
  };
  /// The factor for the next node. eta is at most eta_max, and eta_max at the start itself.
  Value value() const;

  /// Call after loop closing at a node, with the number of new constraints C_i.
  void add_frame(int loops);

 private:
  PsiOptions options_;
  std::optional<mrpt::math::TPoint2D> start_;
  double from_start_m_ = 0;
  double path_m_ = 0;
  std::deque<int> loops_;  ///< of the last K frames
};

}  // namespace psi_slam
