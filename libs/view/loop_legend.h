// SPDX-License-Identifier: BSD-3-Clause
// What the colours of the loops in a MapScene mean.
#pragma once

#include <mrpt/img/TColor.h>

#include <string>
#include <vector>

#include "replay/replay_snapshot.h"
#include "view/map_scene.h"

namespace psi_slam {

/// Found, but not in the graph, by the program's judgement or a person's: drawn only where LoopStyle::refused.
bool was_no_loop(LoopVerdict verdict);

/// The colour in which a scene with this style draws a loop.
mrpt::img::TColor loop_colour(const LoopRecord& loop, const ReplaySnapshot& snapshot, const LoopStyle& style);

struct LoopLegend {
  struct Entry {
    std::string name;
    mrpt::img::TColor colour;
    bool operator==(const Entry& other) const { return name == other.name && colour == other.colour; }
  };
  std::string title;
  std::vector<Entry> entries;  ///< none: no loop is drawn

  bool operator==(const LoopLegend& other) const { return title == other.title && entries == other.entries; }
};

/// Of the loops that are drawn: their matchers, or the scale of the residual, and verdicts other than
/// accepted.
LoopLegend loop_legend(const ReplaySnapshot& snapshot, const LoopStyle& style);

}  // namespace psi_slam
