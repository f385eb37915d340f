// SPDX-License-Identifier: BSD-3-Clause
// Judges the loops of a run as true or false, by relations known to be true.
//
// A relation can judge a loop if one of its ends lies on the robot's path near the loop's node, and its other
// end near the nodes of the loop's local map. The loop as it was matched and the front end's motion from node
// and anchor to the relation's ends predict the relation. The optimised graph plays no part. Distances are
// along the path, where the front end's motion is accurate.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "evaluation/relations_metric.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct LoopJudgementOptions {
  /// Largest distance along the path from a relation's end to the loop's node or local map.
  double near_m = 1.0;
  /// A loop is false if it predicts the relation with a larger error than these limits, which grow with the
  /// distance along the path in between.
  double max_error_m = 0.5;
  double max_error_rad = radians_from_degrees(5.0L);
  double drift_m_per_metre = 0.02;
  double drift_rad_per_metre = radians_from_degrees(0.2L);
  double max_gap_s = 2.0;  ///< longest gap between two scans to interpolate in
  /// A relation joins two passes of a place if its ends are at least this far apart along the path ...
  double min_travel_m = 10.0;
  double max_distance_m = 2.0;  ///< ... and at most this far apart in truth
};

/// A loop and the relation that judges it: of all that can, the one nearest along the path.
struct JudgedLoop {
  std::size_t loop = 0;      ///< index in MappingResult::loops
  std::size_t relation = 0;  ///< index in the relations
  double error_m = 0;        ///< of the relation as the loop predicts it
  double error_rad = 0;
  double way_m = 0;  ///< along the path from the relation's ends to the loop's node and to the anchor
  bool is_false = false;
};

struct LoopJudgement {
  std::vector<JudgedLoop> judged;      ///< in the order of the loops
  std::vector<JudgedLoop> false_ones;  ///< the false loops among them
  std::size_t unjudged = 0;            ///< loops that no relation can judge
  std::size_t passes = 0;              ///< relations that join two passes of a place
  std::size_t joined = 0;              ///< of these, the ones whose two places a loop joins

  /// Returns 1 - false / judged, or nothing if no loop was judged.
  std::optional<double> precision() const;
  /// Returns joined / passes, or nothing if no relation joins two passes.
  std::optional<double> recall() const;
};

/// Judges the accepted loops. Ignores relations with times outside the run.
LoopJudgement judge_loops(const MappingResult& result, const std::vector<Relation>& relations,
                          const LoopJudgementOptions& options = {});

}  // namespace psi_slam
