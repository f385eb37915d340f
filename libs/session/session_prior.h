// SPDX-License-Identifier: BSD-3-Clause
// The prior map of a mapping session: settings [prior].
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "localization/prior_map.h"
#include "localization/reference_map.h"
#include "map/exports/run_summary.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/mapper.h"
#include "session/session_recording.h"
#include "session/settings.h"

namespace psi_slam {

/// Throws UserError if a prior map contradicts other settings or the knowledge, because both state the frame
/// of the map, if prior.extend lacks a prior map, or if settings for drawings lack a drawing.
void check_prior(const Settings& settings, const FixedKnowledge& knowledge);

/// Throws UserError if the prior map is a grid map in the folder of the results, which may replace it.
void check_prior_apart(const Settings& settings, const std::filesystem::path& results_folder);

class SessionPrior {
 public:
  /// Reads the prior map. Throws UserError if its file is unreadable, or if the map cannot be extended.
  explicit SessionPrior(const Settings& settings);

  /// Adds the places of the run in the prior map to the knowledge. Returns why the run cannot be aligned, one
  /// sentence; empty if it is aligned. `progress` gets the completed share of the search, in [0, 1]. If it
  /// returns false, the run is not aligned.
  std::optional<std::string> place(const Mapper& mapper, FixedKnowledge& knowledge,
                                   const std::function<bool(double)>& progress = {});

  /// Returns the prior map for the facts of a session.
  const RecordedPrior& recorded() const { return recorded_; }
  /// Notes the facts of a session from which this one continues. From then on, changed_text() returns a
  /// sentence without full stop if the file of the prior map has changed since the session was saved.
  void compare_with(const SessionFacts& facts);
  const std::optional<std::string>& changed_text() const { return changed_text_; }

  /// Returns how the run fits, by the last call of place().
  const PriorFit& fit() const { return fit_; }
  /// Returns whether the last call of place() was stopped by its `progress`.
  bool is_interrupted() const { return is_interrupted_; }

  /// Returns the walls of the prior map that the finished map shows as free space, as sentences. Empty if the
  /// run is not aligned.
  std::vector<std::string> compare(const mrpt::maps::COccupancyGridMap2D& map) const;

  /// Returns whether the exported map is the prior map, brought up to date with this map of the run.
  bool extends(const mrpt::maps::COccupancyGridMap2D& map) const;

  /// Returns the prior map, brought up to date with `map` (extended_map.h); a copy of `map` if the run is not
  /// aligned, or if both maps have cells of different sizes.
  mrpt::maps::COccupancyGridMap2D::Ptr extended(const mrpt::maps::COccupancyGridMap2D& map) const;

 private:
  /// Walls within this distance of each other are the same wall.
  double tolerance_m() const;

  PriorOptions options_;
  std::vector<std::string> layers_;  // of a drawing; before file_, whose initialiser sets it
  PlacedMapFile file_;
  RecordedPrior recorded_;  // after file_, which checks that the file is readable
  std::optional<std::string> changed_text_;
  PriorMap map_;
  PriorFit fit_;
  bool is_interrupted_ = false;
};

}  // namespace psi_slam
