// SPDX-License-Identifier: BSD-3-Clause
// The factor Psi, equations 13 and 14: the recent rate of closed loops times the ratio of travelled path to
// distance from the start.
//
//     Psi_k = eta_k * (1/K) sum of C_i over the K loop searches before k,
//     eta_k = (sum of d_j over all j <= k) / |t'_k - t_0|
//
// The mean is over the nodes that searched for loops, because a mean over all nodes or scans would depend on
// their spacing. A search without any local map nearby counts, with C_i = 0. The path lengths d_j are summed
// over all scans.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <deque>
#include <optional>

namespace psi_slam {

struct PsiOptions {
  double psi_1 = 1;  ///< kCsm searches windows of at most max_poses poses for Psi <= psi_1
  /// kGa searches for Psi >= psi_2, and kCsmGa between psi_1 and psi_2. By default kCsmGa is never chosen:
  /// share/doc/matchers.md has the measurements.
  double psi_2 = 1;
  /// Number of poses of a window up to which Psi chooses the matcher. kGa searches larger windows.
  double max_poses = 3e6;
  int window_frames = 20;  ///< K of equation 13: number of loop searches in the mean, >= 1
  double eta_max = 20;     ///< upper bound of eta, which is infinite at the start
};

class LoopClosureFactor {
 public:
  explicit LoopClosureFactor(const PsiOptions& options) : options_(options) {}

  /// Adds the motion since the last scan, which has the length `odometry_m` by odometry. `robot` is the
  /// robot's position in the map; the first position is t_0. Call for every scan.
  void move(double odometry_m, const mrpt::math::TPoint2D& robot);

  struct Value {
    double psi = 0;
    double eta = 0;
    double mean_loops = 0;  ///< mean of C_i over the last K loop searches; 0 before the first search
  };
  /// Returns the factor for the next node. eta is at most eta_max, also at the start.
  Value value() const;

  /// Adds C_i, the number of new loop constraints of a node. Call after loop closing at every node that
  /// searched for loops.
  void add_search(int loops);

 private:
  PsiOptions options_;
  std::optional<mrpt::math::TPoint2D> start_;
  double from_start_m_ = 0;
  double path_m_ = 0;
  std::deque<int> loops_;  ///< C_i of the last K loop searches
};

}  // namespace psi_slam
