// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "local_maps/front_end.h"
#include "localization/global_search.h"
#include "loop_closure/loop_consensus.h"

namespace psi_slam {

/// Options of Localizer: section [localization] of settings files, and what it shares with mapping.
struct LocalizerOptions {
  FrontEndOptions front_end;  ///< measures the motion
  GlobalSearchOptions search;
  LoopConsensusOptions consensus;
  std::uint64_t seed = 1;

  double search_travel_m = 1.0;  ///< while lost: travel between two searches

  // While tracking.
  double window_m = 0.3;  ///< half-width of the search window
  double window_rad = radians_from_degrees(6.0L);
  double prior_sigma_m = 0.05;  ///< standard deviation of the predicted motion
  double prior_sigma_rad = radians_from_degrees(2.0L);
  double start_window_m = 1.0;  ///< half-width of the window around a start pose given by the user
  double start_window_rad = radians_from_degrees(15.0L);
  double min_response = 0.3;
  double min_observed_share = 0.5;  ///< fraction of a scan's points in space that the map has observed
  double min_agree = 0.6;           ///< fraction of these points on occupied cells
  double max_misfit_m = 2.0;        ///< the robot is lost after this travel without a fitting scan,
  double max_misfit_s = 5.0;        ///< or after this time
};

}  // namespace psi_slam
