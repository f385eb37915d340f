// SPDX-License-Identifier: BSD-3-Clause
// Which of a run's loops are true, by the relations that are known to be.
//
// A relation judges a loop when one of its ends lies on the robot's path near the loop's node and the other
// near the nodes of the loop's local map. The relation is then predicted from the loop as it was matched and
// from the short ways between, which the front end measured before any loop was closed: what the optimised
// graph made of the loop plays no part. Near is meant along the path, where the front end knows its motion.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/mapping_result.h"
#include "evaluation/relations_metric.h"

namespace psi_slam {

struct LoopJudgementOptions {
  double near_m = 1.0;  ///< of the path, at most between a relation's end and the loop's node or local map
  double max_error_m = 0.5;  ///< a loop that predicts the relation worse than this is false, ...
  double max_error_rad = radians_from_degrees(5.0L);  ///< ... or worse than this;
  double drift_m_per_metre = 0.02;                    ///< both grow with the way in between
  double drift_rad_per_metre = radians_from_degrees(0.2L);
  double max_gap_s = 2.0;  ///< the longest gap between two scans to interpolate in
  double min_travel_m =
      10.0;  ///< of the path, between the ends of a relation that joins two passes of a place,
  double max_distance_m = 2.0;  ///< which truly are at most this far from each other
};

/// One loop and the relation that judged it: of all that could, the one with the shortest way in between.
struct JudgedLoop {
  std::size_t loop = 0;      ///< in MappingResult::loops
  std::size_t relation = 0;  ///< in the relations
  double error_m = 0;        ///< of the relation as the loop predicts it
  double error_rad = 0;
  double way_m = 0;  ///< of the path: from the relation's ends to the loop's node and to the anchor
  bool is_false = false;
};

struct LoopJudgement {
  std::vector<JudgedLoop> judged;      ///< in the order of the loops
  std::vector<JudgedLoop> false_ones;  ///< of them
  std::size_t unjudged = 0;            ///< loops that no relation speaks of
  std::size_t passes = 0;              ///< relations that join two passes of a place
  std::size_t joined = 0;              ///< of those, the ones whose neighbourhoods a loop joins

  /// 1 - false / judged; none when nothing was judged.
  std::optional<double> precision() const;
  /// joined / passes; none when no relation joins two passes.
  std::optional<double> recall() const;
};

/// Of the accepted loops. Relations whose times the run does not know are left out.
LoopJudgement judge_loops(const MappingResult& result, const std::vector<Relation>& relations,
                          const LoopJudgementOptions& options = {});

}  // namespace psi_slam
