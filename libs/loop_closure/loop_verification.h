// SPDX-License-Identifier: BSD-3-Clause
// Whether a match is believed (method, section 7). A high response alone accepts wrong loops in corridors,
// and one false loop ruins a map; so a match must also be unique within its window, well determined, lie in
// space the local map has observed, agree with the scans taken around it, and agree when looked at from the
// other side.
#pragma once

#include "psi_slam/loop_record.h"
#include "loop_closure/keyframe_store.h"

namespace psi_slam {

struct LoopVerificationOptions {
  double min_response = 0.5;           ///< of a scan in a narrow window
  double min_context_response = 0.35;  ///< of a context in a wide one: the local map holds only a part of it
  double max_ambiguity = 0.9;       ///< of a match in a narrow window; wide ones leave that to the consensus
  double wide_window_m = 1.0;       ///< windows with a larger half-width are wide
  double max_sigma_m = 0.3;         ///< largest standard deviation of the matched position
  double min_observed_share = 0.5;  ///< of the scan's points, in space that the local map has observed; of a
                                    ///< match in a narrow window
  double min_neighbours_agree =
      0.75;  ///< of the neighbouring scans' points in observed space, on something occupied
  double min_reverse_agree =
      0.75;                      ///< of the local map's points that the scan sees, on what the scan measured
  double neighbourhood_m = 3.0;  ///< scans this far along the path, before and after, are neighbours
};

bool is_wide(const SearchExtent& extent, const LoopVerificationOptions& options);

/// What a match in this window must score.
double min_response(const SearchExtent& extent, const LoopVerificationOptions& options);

/// Loops are looked for down to this share of min_response(), so that a person sees what was refused and why.
inline constexpr double kReportedShare = 0.8;

/// Fills in what was found out of `loop` (observed share, agreements) and decides its verdict: refused, with
/// the reason; accepted; or, found in a wide window, pending until others agree (see LoopConsensus). `scan`
/// is what was matched.
void verify(LoopRecord& loop, const ScanPoints& scan, const KeyframeStore& memory,
            const LoopVerificationOptions& options);

}  // namespace psi_slam
