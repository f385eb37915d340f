// SPDX-License-Identifier: BSD-3-Clause
// What is known from outside, assigned to the nodes of a finished run. Each stated pose and each tag is a
// landmark of the pose graph.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pose_graph/known_landmarks.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

class PlacedKnowledge {
 public:
  /// Assigns the knowledge to the nodes that were nearest before its times. `node_frames` and
  /// `later_run_frames` are as in MappingResult. What no scan can use is left out and becomes a complaint.
  PlacedKnowledge(FixedKnowledge knowledge, const std::vector<FrameRecord>& frames,
                  const std::vector<std::size_t>& node_frames,
                  const std::vector<std::size_t>& later_run_frames);

  /// One for each stated pose, in the order of their times, and then for each tag, in the order of the names.
  const std::vector<Landmark>& landmarks() const { return landmarks_; }

  /// Returns what was left out, and what the optimised graph contradicts by more than `max_chi` stated
  /// standard deviations; one sentence each. `in_graph` holds landmarks().
  std::vector<std::string> contradictions(const KnownLandmarks& in_graph, const PoseGraph& graph,
                                          double max_chi) const;

  /// Counts the statements. Arguments as for contradictions().
  KnowledgeCounts counts(const KnownLandmarks& in_graph, const PoseGraph& graph) const;

 private:
  /// A moment of the run: the robot relative to a node.
  struct Moment {
    std::size_t node = 0;
    mrpt::math::TPose2D node_T_robot;
  };
  /// What a landmark stands for: a stated pose, or a tag with its place and sightings.
  struct Origin {
    std::optional<KnownPose> pose;
    std::optional<TagPlace> place;
    std::vector<TagSighting> sightings;
  };

  std::optional<std::string> contradicted_matches(const KnownLandmarks& in_graph, const PoseGraph& graph,
                                                  double max_chi) const;
  void add_pose(const KnownPose& pose, const std::optional<Moment>& moment);
  void add_tag(const std::string& name, const FixedKnowledge& knowledge,
               const std::vector<std::pair<TagSighting, Moment>>& sightings);

  std::vector<Landmark> landmarks_;
  std::vector<Origin> origins_;  ///< one for each landmark
  std::vector<std::string> complaints_;
  std::size_t stated_ = 0;  ///< number of statements, see KnowledgeCounts
};

}  // namespace psi_slam
