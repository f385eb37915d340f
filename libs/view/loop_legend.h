// SPDX-License-Identifier: BSD-3-Clause
// Colours of the loops in a MapScene, and their legend.
#pragma once

#include <mrpt/img/TColor.h>

#include <string>
#include <vector>

#include "replay/replay_snapshot.h"
#include "view/map_scene.h"

namespace psi_slam {

/// True for matches that were refused or deleted. They are drawn only with LoopStyle::refused.
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
  std::vector<Entry> entries;  ///< empty if no loop is drawn

  bool operator==(const LoopLegend& other) const { return title == other.title && entries == other.entries; }
};

/// Legend of the drawn loops: their matchers, or the scale of residuals, and the verdicts except "accepted".
LoopLegend loop_legend(const ReplaySnapshot& snapshot, const LoopStyle& style);

}  // namespace psi_slam
