// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/keyframe_store.h"

#include <algorithm>

#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "frames/pose_operations.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

constexpr std::size_t kUnpackedLocalMaps = 48;

}  // namespace

double travel_and_turn_m(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to) {
  const mrpt::math::TPose2D motion = between(from, to);
  return portable::hypot(motion.x, motion.y) + kTravelOfTurn_m * std::abs(motion.phi);
}

bool is_unplaced(std::size_t node, const KeyframeStore& keyframes) {
  return std::any_of(keyframes.unplaced.begin(), keyframes.unplaced.end(),
                     [&](const UnplacedRun& run) { return run.contains(node); });
}

bool are_joined(std::size_t node, std::size_t other, const KeyframeStore& keyframes) {
  return std::all_of(keyframes.unplaced.begin(), keyframes.unplaced.end(),
                     [&](const UnplacedRun& run) { return run.contains(node) == run.contains(other); });
}

KeyframeStore make_keyframe_store() {
  KeyframeStore keyframes;
  keyframes.cache = std::make_shared<LocalMapCache>(kUnpackedLocalMaps);
  return keyframes;
}

void remember_node(const FrontEndStep& step, std::size_t frame, KeyframeStore& keyframes) {
  NodeScan node;
  node.frame = frame;
  node.local_T_robot = step.local_T_robot;
  node.points = step.points;
  if (!keyframes.nodes.empty()) {
    const mrpt::math::TPose2D motion = between(keyframes.nodes.back().local_T_robot, step.local_T_robot);
    node.travelled_m = keyframes.nodes.back().travelled_m + portable::hypot(motion.x, motion.y);
  }
  keyframes.nodes.push_back(std::move(node));
}

void constrain_to_local_maps(const FrontEndStep& step, const LocalMapNoise& noise, PoseGraph& graph) {
  for (const FrontEndStep::Membership& membership : step.memberships) {
    Constraint constraint;
    constraint.kind = Constraint::Kind::kLocalMap;
    constraint.from = membership.anchor;
    constraint.to = step.node.value();
    constraint.from_T_to = membership.anchor_T_node;
    constraint.information = noisy_information(membership.covariance, noise.sigma_m, noise.sigma_rad);
    graph.add_constraint(constraint);
  }
}

void remember_local_map(const PlacedLocalMap& finished, KeyframeStore& keyframes) {
  keyframes.local_maps.push_back(finished);
  if (keyframes.cache) keyframes.cache->add(finished.map);
}

void unpack_local_maps(const KeyframeStore& keyframes, const std::vector<std::size_t>& local_maps,
                       WorkerPool& pool) {
  if (keyframes.cache) keyframes.cache->use(local_maps, pool);
}

bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m) {
  if (node == 0 || stretch_m <= 0) return true;
  const auto stretch = [&](std::size_t i) { return std::floor(nodes[i].travelled_m / stretch_m); };
  return stretch(node) != stretch(node - 1);
}

}  // namespace psi_slam
