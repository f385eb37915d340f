// SPDX-License-Identifier: BSD-3-Clause
// A made-up verdict with one hot spot, for the tests of exports and reports.
#pragma once

#include "map/verdict/map_verdict.h"

namespace psi_slam {

/// A doubled wall, for which the loop of scan 45 with local map 3 is the suspect.
inline MapVerdict doubtful_map() {
  MapVerdict verdict;
  verdict.state = MapState::kCheck;
  verdict.error_m = 0.06;
  verdict.checked_share = 0.4;
  HotSpot spot;
  spot.at = {1.5, -0.5};
  spot.error_m = 0.31;
  spot.length_m = 2;
  spot.suspect.kind = Suspect::Kind::kLoop;
  spot.suspect.loop = 1;
  spot.suspect.local_map = 3;
  spot.suspect.last_frame = 45;
  spot.suspect.at = {2, 1};
  spot.edit = LoopEdit{LoopEdit::Kind::kDelete, 45, 3};
  verdict.hot_spots = {spot};
  return verdict;
}

}  // namespace psi_slam
