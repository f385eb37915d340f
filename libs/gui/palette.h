// SPDX-License-Identifier: BSD-3-Clause
// Colours shared by scenes, plots, tables and legends, and the legend of the loops in a MapScene.
#pragma once

#include <string>
#include <vector>

#include "gui/map_scene.h"

namespace psi_slam {

namespace palette {
inline constexpr mrpt::img::TColor kBackground{236, 238, 241};
inline constexpr mrpt::img::TColor kCorrected{31, 97, 171};
inline constexpr mrpt::img::TColor kUnmatched{214, 30, 40, 150};
inline constexpr mrpt::img::TColor kOdometry{196, 132, 52, 170};
inline constexpr mrpt::img::TColor kNode{31, 97, 171};
inline constexpr mrpt::img::TColor kUncertainty{0, 130, 80};
inline constexpr mrpt::img::TColor kHotSpot{200, 0, 140};
inline constexpr mrpt::img::TColor kConstraint{120, 132, 150, 130};
inline constexpr mrpt::img::TColor kScan{222, 45, 38};
inline constexpr mrpt::img::TColor kRobot{20, 24, 32};
inline constexpr mrpt::img::TColor kWindow{214, 112, 0};
inline constexpr mrpt::img::TColor kOlderMap{0, 120, 140};
inline constexpr mrpt::img::TColor kNewerMap{140, 70, 160};
inline constexpr mrpt::img::TColor kChosen{255, 0, 160};
inline constexpr mrpt::img::TColor kMeasure{200, 0, 90};
inline constexpr mrpt::img::TColor kBefore{224, 130, 20};
inline constexpr mrpt::img::TColor kAfter{0, 130, 80};
}  // namespace palette

/// Colour of a matcher in plots, tables and scenes.
mrpt::img::TColor matcher_colour(MatcherKind matcher);

/// Colour of a loop in tables: of its state, and of outlier loops among the rejected ones.
mrpt::img::TColor state_colour(const LoopRecord& loop);

/// Colour of an edit of the drawn map while it is drawn, and of zones.
mrpt::img::TColor map_edit_colour(MapEdit::Kind kind);

/// Colour from green (0) over yellow to red (1); values outside [0, 1] are clamped.
mrpt::img::TColor heat_colour(double share);

/// Colour in which a scene with this style draws a loop.
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

/// Legend of the drawn loops: matchers or the residual scale for accepted loops, states for all others.
LoopLegend loop_legend(const ReplaySnapshot& snapshot, const LoopStyle& style);

}  // namespace psi_slam
