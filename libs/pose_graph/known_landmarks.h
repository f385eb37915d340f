// SPDX-License-Identifier: BSD-3-Clause
// Landmarks in a pose graph: marks at fixed places that nodes have seen, with or without a place that is
// known from outside. A pose of the robot that is known from outside is a mark that one node saw nearly
// without error.
//
// The graph gets a node for each mark, and one for the frame of the site if the place of any mark is known.
// The site's node is a point of the site near the first mark, with the axes of the site: coordinates of a
// site may be large. Before the constraints are used, pairwise consistency decides which of them are false
// (Mangelson et al., "Pairwise consistent measurement set maximization for robust multi-robot map merging",
// ICRA 2018). The others have no robust kernel, so they hold. The covariance between two nodes is that of the
// path, see graph_with_shared_errors(), plus the error of the scale of odometry.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// A mark as a node saw it.
struct LandmarkSighting {
  std::size_t node = 0;
  MeasuredPose node_T_mark;
};

/// A mark at a fixed place.
struct Landmark {
  std::optional<MeasuredPose> site_T_mark;  ///< place by knowledge from outside; empty: unknown
  std::vector<LandmarkSighting> sightings;  ///< at least one
};

/// How far the graph is from a stated measurement.
struct KnownResidual {
  double distance_m = 0;
  std::optional<double> turn_rad;  ///< absolute value; empty if the measurement has no heading
  double chi = 0;                  ///< stated standard deviations
};

struct SeenMark;

/// The landmarks of a pose graph. Add no further nodes to the graph after the landmarks.
class KnownLandmarks {
 public:
  /// Adds the nodes of the landmarks to the graph, without their constraints. The graph stays connected.
  KnownLandmarks(std::vector<Landmark> landmarks, PoseGraph& graph);

  /// Disables all constraints of the landmarks.
  void switch_off(PoseGraph& graph) const;

  /// Places the landmarks by the graph's poses, which must not depend on the landmarks. Adds the constraints,
  /// and switches on those that agree with each other and with the graph within `max_chi` standard
  /// deviations. The result depends on the order of the landmarks only if equally many contradict each other.
  void select(PoseGraph& graph, double max_chi);

  /// Moves all nodes so that their poses are in the frame of the site, whose node becomes the root. Does
  /// nothing if no place is known.
  void move_to_site(PoseGraph& graph) const;

  // Call select() before the following functions.

  /// Returns whether the graph uses the known place of a landmark. The landmark must have a place.
  bool uses_place(std::size_t landmark, const PoseGraph& graph) const;
  /// Returns whether the graph uses a sighting of a landmark.
  bool uses_sighting(std::size_t landmark, std::size_t sighting, const PoseGraph& graph) const;

  /// Residual of the place of a landmark. The landmark must have a place.
  KnownResidual place_residual(std::size_t landmark, const PoseGraph& graph) const;
  KnownResidual sighting_residual(std::size_t landmark, std::size_t sighting, const PoseGraph& graph) const;

 private:
  struct Numbers {  ///< numbers of the node and the constraints of a landmark
    std::size_t node = 0;
    std::optional<std::size_t> place;
    std::vector<std::size_t> sightings;
  };
  class Consistency;

  void add_constraints(PoseGraph& graph);
  void enable_sightings(std::size_t landmark, const std::vector<bool>& enabled, PoseGraph& graph) const;
  std::vector<SeenMark> placed_marks(const PoseGraph& graph, std::vector<std::size_t>& numbers) const;
  std::size_t best_sighting(std::size_t landmark, const PoseGraph& graph) const;
  void place_nodes(PoseGraph& graph) const;
  mrpt::math::TPose2D placed_site(const PoseGraph& graph) const;

  std::vector<Landmark> landmarks_;
  std::vector<Numbers> numbers_;
  std::optional<std::size_t> site_;  ///< node of the site
  mrpt::math::TPose2D site_T_root_;  ///< point of the site that its node stands for
};

}  // namespace psi_slam
