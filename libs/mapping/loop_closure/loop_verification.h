// SPDX-License-Identifier: BSD-3-Clause
// Verification of a match. A single false loop ruins a map, and in corridors even false matches have high
// responses. So a high response is not enough. A match must also be unique in its window, and the scan must
// determine the position. The scan must lie in space that the local map observed.
// Neighbouring scans must fit the local map, and points of the local map must fit the scan.
#pragma once

#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/loop_record.h"

namespace psi_slam {

struct LoopVerificationOptions {
  double min_response = 0.5;  ///< minimum response of a scan in a narrow window
  /// Minimum response of a context in a wide window. It is lower than min_response, because the local map
  /// holds only part of the context.
  double min_context_response = 0.35;
  double max_ambiguity = 0.9;  ///< largest ambiguity in a narrow window; LoopConsensus handles wide windows
  double wide_window_m = 1.0;  ///< windows with a larger half-width along x or y are wide
  double max_sigma_m = 0.3;    ///< largest standard deviation of the matched position
  /// Minimum share of the scan's points in space that the local map observed; only in narrow windows.
  double min_observed_share = 0.5;
  /// Minimum share of the neighbouring scans' points in observed space that fit occupied cells.
  double min_neighbours_agree = 0.75;
  /// Of the local map's points visible from the scan, minimum share that agrees with the scan's ranges.
  double min_reverse_agree = 0.75;
  double neighbourhood_m = 3.0;  ///< scans within this path length, before and after, are neighbours
};

bool is_wide(const SearchExtent& extent, const LoopVerificationOptions& options);

/// Returns the minimum response of a match in this window.
double min_response(const SearchExtent& extent, const LoopVerificationOptions& options);

/// Returns the least response of a match that a search reports. In narrow windows it is below min_response(),
/// so that records show which matches were rejected, and why. In wide windows that would cost much time.
double least_reported_response(const SearchExtent& extent, const LoopVerificationOptions& options);

/// Returns the least response of a match by hand. It is below min_response() in all windows, so that records
/// show which matches were rejected.
double least_response_by_hand(const SearchExtent& extent, const LoopVerificationOptions& options);

/// Sets the state, the shares and the rejection of `loop`. A verified match in a wide window is a candidate
/// until other matches agree, see LoopConsensus. `scan` holds the points that were matched.
void verify(LoopRecord& loop, const ScanPoints& scan, const KeyframeStore& keyframes,
            const LoopVerificationOptions& options);

}  // namespace psi_slam
