// SPDX-License-Identifier: BSD-3-Clause
// The comparison of two maps as a sentence, as a table and as JSON.
#pragma once

#include <string>
#include <vector>

#include "localization/comparison/map_alignment.h"
#include "localization/comparison/wall_changes.h"

namespace psi_slam {

/// A comparison of two maps and the limits it was made with.
struct MapComparison {
  MapAlignment alignment;
  WallChangeOptions limits;  ///< tolerance_m includes the uncertainty of the alignment
  WallChanges walls;

  bool changed() const { return !walls.changes.empty(); }
};

/// Name of a kind of change in tables and JSON: "appeared", "vanished" or "moved".
const char* name(WallChange::Kind kind);

/// Returns two lines: the changes, and the alignment with its standard deviations.
std::string comparison_text(const MapComparison& comparison);

/// Returns the alignment, the limits, and number and length of the changes of each kind.
std::string comparison_json(const MapComparison& comparison);

/// Returns a table with one row for each change: its kind, middle, ends, length and shift, in metres in the
/// frame of map A. The shift is empty for walls that have not moved.
std::string changes_csv(const std::vector<WallChange>& changes);

}  // namespace psi_slam
