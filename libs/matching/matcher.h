// SPDX-License-Identifier: BSD-3-Clause
// The interface of all scan matchers. A matcher takes a scan, a score grid and a search window, and returns
// the matched pose with its response, covariance and ambiguity. Matchers differ only in how they search the
// window.
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
#include "psi_slam/matching.h"

namespace psi_slam {

/// Seed of the random generator for one match. It makes results independent of the number and order of
/// threads.
struct MatchSeed {
  std::uint64_t run = 0;        ///< seed of the whole run
  std::uint64_t scan = 0;       ///< number of the scan in the log
  std::uint64_t local_map = 0;  ///< number of the local map
};

struct MatchProblem {
  const ScoreGrid& grid;   ///< in the frame of its local map; `map` in names of poses means this frame
  const ScanPoints& scan;  ///< in the robot's frame
  mrpt::math::TPose2D map_T_robot;  ///< predicted pose: the centre of the window
  SearchExtent extent;              ///< half-widths of the window
  double min_response = 0;  ///< smallest response of a match, in [0, 1]; higher values speed up the search
  bool measure_ambiguity = false;       ///< whether to find the second-best distinct peak too
  std::optional<PosePrior> prior = {};  ///< determines the refined pose where the scan does not
  MatchSeed seed = {};
};

struct MatchResult {
  bool found = false;                ///< false: no pose of the window reaches min_response
  mrpt::math::TPose2D map_T_robot;   ///< matched pose, refined below a cell
  mrpt::math::TPose2D lattice_pose;  ///< best pose of the search lattice, before refinement
  double response = 0;               ///< R_v of equation 11 at lattice_pose, in [0, 1]
  double refined_response = 0;       ///< mean interpolated score at map_T_robot
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();   ///< covariance of map_T_robot: m^2, m rad, rad^2
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< information of the scan alone; see refine()
  /// Response of the second-best distinct pose of the window (see MatcherOptions), divided by `response`.
  /// Empty if not measured. 0 if no distinct pose reaches MatcherOptions::ambiguity_floor.
  std::optional<double> ambiguity;
  SearchWindow window;  ///< window that was searched
  /// Search that ran. In narrow windows, genetic matchers also search for the second peak exactly.
  SearchKind search = SearchKind::kExhaustive;
  std::int64_t evaluations = 0;  ///< number of poses scored, on all levels of the grid
};

class Matcher {
 public:
  virtual ~Matcher() = default;

  /// Searches the window for the pose with the best response. Throws std::invalid_argument for a degenerate
  /// window (see make_search_window) and for a grid without a pyramid if the search needs one. Thread-safe.
  virtual MatchResult match(const MatchProblem& problem) const = 0;

  /// Name in `.ini` files and records: "csm", "csm_ga" or "ga".
  virtual std::string name() const = 0;
};

}  // namespace psi_slam
