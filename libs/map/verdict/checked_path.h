// SPDX-License-Identifier: BSD-3-Clause
// Which parts of the path comparisons between passes check, and which they do not.
//
// Two views of different passes that fit hold the path between them: the robot left a place, came back, and
// saw the same walls. What lies beyond the last place that was seen twice is held by nothing.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "map/verdict/map_views.h"
#include "map/verdict/pass_checks.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns the share of the views that lie between two views of their run that fit another pass, in [0, 1].
/// Two views of one run must fit each other; views that fit one other run hold the path between the first and
/// the last of them. Comparisons fit if their error is below `spot_error_m`. Zero without views.
double held_share(const std::vector<MapView>& views, const std::vector<PassCheck>& checks,
                  double spot_error_m);

/// Successive views of one run that were compared with no other pass.
struct UncheckedStretch {
  std::size_t first_frame = 0;
  std::size_t last_frame = 0;
  double length_m = 0;            ///< path from the first view to the last
  mrpt::math::TPoint2D first_at;  ///< place of the first view in the map, metres
  mrpt::math::TPoint2D last_at;   ///< place of the last view in the map, metres
  /// Largest standard deviation of the position by the pose graph; empty: that of a view is unknown.
  std::optional<double> sigma_m;
};

/// Returns the stretches of views without an error in `errors_m` (see errors_of_views()) from least_length_m
/// on, the most uncertain first. `sigmas_m` has one entry for each view; see aligned_sigmas_m().
std::vector<UncheckedStretch> unchecked_stretches(const std::vector<MapView>& views,
                                                  const std::vector<std::optional<double>>& errors_m,
                                                  const std::vector<std::optional<double>>& sigmas_m,
                                                  double least_length_m);

}  // namespace psi_slam
