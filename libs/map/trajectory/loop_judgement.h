// SPDX-License-Identifier: BSD-3-Clause
// Judges the loops of a run as true or false, by relations known to be true (see Relation).
//
// A relation can judge a loop if one of its ends lies near the loop's node on the robot's path, and its other
// end near the nodes of the loop's local map. The relation is predicted from the loop as it was matched, and
// from the front end's motion between the loop and the ends of the relation. The optimised graph is not used.
// Distances are measured along the path, because the front end is accurate over short paths.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "map/trajectory/relations_metric.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct LoopJudgementOptions {
  /// Largest distance along the path from a relation's end to the loop's node or local map.
  double near_m = 1.0;
  /// A loop is false if its error exceeds one of these limits. The limits grow with the distance along the
  /// path between the loop and the ends of the relation.
  double max_error_m = 0.5;
  double max_error_rad = radians_from_degrees(5.0L);
  double drift_m_per_metre = 0.02;
  double drift_rad_per_metre = radians_from_degrees(0.2L);
  double max_gap_s = 2.0;  ///< longest gap between two scans that is interpolated
  /// A relation joins two passes of a place if its ends are at least `min_travel_m` apart along the path, and
  /// truly at most `max_distance_m` apart.
  double min_travel_m = 10.0;
  double max_distance_m = 2.0;  ///< largest true distance between two passes of a place
};

/// A loop and the relation that judges it: of all relations that can judge the loop, the nearest along the
/// path.
struct JudgedLoop {
  std::size_t loop = 0;      ///< index in MappingResult::loops
  std::size_t relation = 0;  ///< index in the relations
  double error_m = 0;        ///< translational error of the relation that the loop predicts
  double error_rad = 0;
  /// Distance along the path from one end of the relation to the node, plus that from the other end to the
  /// anchor.
  double way_m = 0;
  bool is_false = false;
};

struct LoopJudgement {
  std::vector<JudgedLoop> judged;      ///< in the order of the loops
  std::vector<JudgedLoop> false_ones;  ///< the false loops among `judged`
  std::size_t unjudged = 0;            ///< loops that no relation can judge
  std::size_t passes = 0;              ///< relations that join two passes of a place
  std::size_t joined = 0;  ///< relations counted in `passes` whose two places an accepted loop joins

  /// Returns the fraction of judged loops that are true, or nothing if no loop was judged.
  std::optional<double> precision() const;
  /// Returns joined / passes, or nothing if no relation joins two passes of a place.
  std::optional<double> recall() const;
};

/// Judges the accepted loops. Ignores relations with times outside the run.
LoopJudgement judge_loops(const MappingResult& result, const std::vector<Relation>& relations,
                          const LoopJudgementOptions& options = {});

}  // namespace psi_slam
