// SPDX-License-Identifier: BSD-3-Clause
// Stretches of the path whose place in the map is uncertain by the pose graph: drift that loops do not hold.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "map/verdict/map_views.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Successive views with a large standard deviation of the position.
struct UncertainStretch {
  std::size_t worst = 0;        ///< view with the largest standard deviation
  double sigma_m = 0;           ///< standard deviation of the position of this view
  double length_m = 0;          ///< path from the first view to the last
  std::size_t first_frame = 0;  ///< last end of a loop before the worst view, or first frame of the run
  std::size_t last_frame = 0;   ///< first end of a loop after the worst view, or last frame of the run
};

/// Returns the stretches of views with standard deviations from least_sigma_m on, in the order of the log.
/// `sigmas_m` has one entry for each view; empty: unknown.
std::vector<UncertainStretch> uncertain_stretches(const MappingResult& result,
                                                  const std::vector<MapView>& views,
                                                  const std::vector<std::optional<double>>& sigmas_m,
                                                  double least_sigma_m);

}  // namespace psi_slam
