// SPDX-License-Identifier: BSD-3-Clause
// The one interface of all scan matchers: a scan, a score grid and a search window in; a match that answers
// everything a caller may ask out. Matchers differ only in how they search the window; sub-cell refinement,
// covariance and ambiguity are the same for all.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "matching/refinement.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"
#include "matching/search_window.h"

namespace psi_slam {

/// What a random matcher seeds its generator with, so that results depend neither on threads nor on order.
struct MatchSeed {
  std::uint64_t run = 0;
  std::uint64_t scan = 0;
  std::uint64_t local_map = 0;
};

struct MatchProblem {
  const ScoreGrid& grid;                ///< in the frame called "map" here: the local map's own
  const ScanPoints& scan;               ///< in the robot's frame
  mrpt::math::TPose2D map_T_robot;      ///< predicted; the window's centre
  SearchExtent extent;                  ///< half-widths of the window
  double min_response = 0;              ///< below this nothing is found; a higher value is a faster search
  bool measure_ambiguity = false;       ///< also look for the next best distinct peak
  std::optional<PosePrior> prior = {};  ///< holds the refinement where the scan alone does not
  MatchSeed seed = {};
};

/// What a genetic search did; all zero for the others.
struct GeneticEffort {
  int generations = 0;
  std::int64_t decoded = 0;   ///< chromosomes that became poses
  std::int64_t repaired = 0;  ///< of those, codes that lay outside the window
};

struct MatchResult {
  bool found = false;                ///< false: no pose of the window reaches min_response
  mrpt::math::TPose2D map_T_robot;   ///< refined below a cell
  mrpt::math::TPose2D lattice_pose;  ///< the best pose of the search lattice, before refinement
  double response = 0;               ///< R_v of equation 11 at the lattice pose, in [0, 1]
  double refined_response = 0;       ///< mean interpolated score at map_T_robot
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();   ///< of map_T_robot: m, m, rad
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the scan alone, unbounded; see refine()
  /// Response of the best pose of the window that is distinct from the result (see MatcherOptions) over the
  /// response; empty where not measured, 0 where no other pose reaches MatcherOptions::ambiguity_floor.
  std::optional<double> ambiguity;
  SearchWindow window;           ///< as searched
  std::int64_t evaluations = 0;  ///< poses scored on any level of the grid
  GeneticEffort genetic;
};

class Matcher {
 public:
  virtual ~Matcher() = default;

  /// Throws std::invalid_argument on a degenerate window (see make_search_window) or a grid without its
  /// pyramid where the search needs it. Safe to call from several threads at once.
  virtual MatchResult match(const MatchProblem& problem) const = 0;

  /// As in the `.ini` and the records: "csm", ...
  virtual std::string name() const = 0;
};

}  // namespace psi_slam
