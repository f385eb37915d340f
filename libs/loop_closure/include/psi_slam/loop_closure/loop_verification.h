// SPDX-License-Identifier: BSD-3-Clause
// Whether a match is believed (method, section 7). A high response alone accepts wrong loops in corridors,
// and one false loop ruins a map; so a match must also be unique within its window, well determined, lie in
// space the local map has observed, agree with the scans taken around it, and agree when looked at from the
// other side.
#pragma once

#include "psi_slam/loop_closure/loop_record.h"
#include "psi_slam/loop_closure/place_memory.h"

namespace psi_slam {

struct LoopVerificationOptions {
  double min_response = 0.5;
  double min_response_wide =
      0.6;  ///< the same for windows wider than `wide_window_m`: there are more chances to err
  double wide_window_m = 1.0;
  double max_ambiguity = 0.9;
  double max_sigma_m = 0.3;  ///< largest standard deviation of the matched position
  double min_observed_share = 0.5;
  double min_neighbours_agree = 0.75;
  double min_reverse_agree = 0.75;
  double neighbourhood_m = 3.0;  ///< scans this far along the path, before and after, are neighbours
};

/// Fills in what was found out of `loop` (observed share, agreements) and decides: its verdict and the
/// reason.
void verify(LoopRecord& loop, const PlaceMemory& memory, const LoopVerificationOptions& options);

}  // namespace psi_slam
