// SPDX-License-Identifier: BSD-3-Clause
// Tries an edit of a loop on the pose graph of a finished map, without mapping the log again: switches the
// constraint of the loop off, or adds one, optimises, moves the nodes and compares the passes again. A match
// is tried with weak path constraints across the suspect: if the suspect is the fault, the map bends there
// and nowhere else.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "map/verdict/edit_effect.h"
#include "map/verdict/map_views.h"
#include "map/verdict/pass_checks.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// The map after an edit.
struct TriedEdit {
  EditEffect effect;
  /// Error of each check after the edit, in the order of the checks. Empty if the views of a check see too
  /// few common points after the edit.
  std::vector<std::optional<double>> errors_m;
};

/// The pose of a node that a match would measure.
struct TriedMatch {
  std::size_t from = 0;  ///< node near which the local map saw the walls
  std::size_t to = 0;    ///< node of the matched scan
  mrpt::math::TPose2D from_T_to;
};

/// Returns the pose of the robot in the map at which most surfaces of a view fit the other view: the best of
/// alignments that start up to 1.5 m and 0.3 rad from the pose of the map. Empty if none fits.
std::optional<mrpt::math::TPose2D> matched_pose(const MapView& view, const MapView& other,
                                                const PassCheckOptions& options);

class EditTrial {
 public:
  /// The arguments must outlive the trial.
  EditTrial(const MappingResult& result, const std::vector<MapView>& views,
            const std::vector<PassCheck>& checks, const PassCheckOptions& options);

  /// Returns the map without an accepted loop. Empty if the graph has no such constraint, or if its
  /// constraints do not link all nodes.
  std::optional<TriedEdit> without_loop(const LoopRecord& loop) const;

  /// Returns the map with a rejected loop that is accepted by force, so it has no robust kernel. Empty as
  /// without_loop() is.
  std::optional<TriedEdit> with_loop(const LoopRecord& loop) const;

  /// Returns the map with a new match, if the path between the frames of `doubtful` is assumed to be wrong.
  std::optional<TriedEdit> with_match(const TriedMatch& match, const FrameSpan& doubtful) const;

 private:
  PoseGraph loosened(const FrameSpan& doubtful) const;
  std::optional<TriedEdit> with_graph(PoseGraph graph) const;
  std::optional<double> error_m(const PassCheck& check, const std::vector<MapView>& moved) const;

  const MappingResult& result_;
  const std::vector<MapView>& views_;
  const std::vector<PassCheck>& checks_;
  const PassCheckOptions& options_;
  std::optional<PoseGraph> settled_;  ///< the graph, optimised without any edit; empty if that is impossible
};

}  // namespace psi_slam
