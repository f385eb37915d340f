// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/keyframe_store.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/newest_covariance.h"

namespace psi_slam {
namespace {

constexpr std::size_t kUnpackedLocalMaps = 48;

// The covariance of a step that the front end states: without a match it is the error of odometry; of a
// match, later scans take back most.
PathCovariance covariance_of(const FrontEndStep& step, const PathNoise& noise) {
  PathCovariance covariance;
  if (step.matched)
    covariance.drift = noise.stated_share * noise.stated_share * step.covariance_since_node;
  else
    covariance.unmatched = step.covariance_since_node;
  return covariance;
}

Eigen::Matrix3d scan_covariance(const PathNoise& noise) {
  const double m2 = noise.scan_sigma_m * noise.scan_sigma_m;
  return Eigen::Vector3d(m2, m2, noise.scan_sigma_rad * noise.scan_sigma_rad).asDiagonal();
}

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

void constrain_to_path(const FrontEndStep& step, const PathNoise& noise, KeyframeStore& keyframes,
                       PoseGraph& graph) {
  const std::size_t node = *step.node;
  NodeScan& here = keyframes.nodes[node];
  here.segment = node;
  PathCovariance covariance = std::exchange(keyframes.in_segment, PathCovariance());
  const std::size_t last_matched = keyframes.last_matched_node;
  if (step.matched || step.memberships.empty()) keyframes.last_matched_node = node;
  if (step.memberships.empty()) return;

  const NodeScan& before = keyframes.nodes.at(node - 1);
  const NodeScan& first = keyframes.nodes[before.segment];
  const mrpt::math::TPose2D first_T_before = between(first.local_T_robot, before.local_T_robot);
  const mrpt::math::TPose2D first_T_here = between(first.local_T_robot, here.local_T_robot);
  const mrpt::math::TPose2D motion = between(before.local_T_robot, here.local_T_robot);
  const double length_m = portable::hypot(motion.x, motion.y);
  const double drift_m2 = noise.sigma_m_per_sqrt_m * noise.sigma_m_per_sqrt_m * length_m;
  const double drift_rad2 =
      noise.sigma_rad_per_sqrt_m * noise.sigma_rad_per_sqrt_m * length_m +
      noise.sigma_rad_per_sqrt_rad * noise.sigma_rad_per_sqrt_rad * std::abs(motion.phi);
  PathCovariance of_step = covariance_of(step, noise);
  of_step.drift.diagonal() += Eigen::Vector3d(drift_m2, drift_m2, drift_rad2);
  const auto extend = [&](Eigen::Matrix3d& sum, const Eigen::Matrix3d& one) {
    sum = carried_covariance(sum, first_T_before, first_T_here) + in_turned_axes(one, first_T_before.phi);
  };
  extend(covariance.drift, of_step.drift);
  extend(covariance.unmatched, of_step.unmatched);
  if (step.matched && step.memberships.front().anchor <= last_matched) {
    covariance.drift += noise.stated_share * noise.stated_share * covariance.unmatched;
    covariance.unmatched.setZero();
  }

  const bool begins = here.travelled_m - first.travelled_m >= kSegment_m;
  Constraint constraint;
  constraint.kind = Constraint::Kind::kLocalMap;
  constraint.from = before.segment;
  constraint.to = node;
  constraint.from_T_to = first_T_here;
  Eigen::Matrix3d drift = covariance.drift;
  if (!begins) drift += scan_covariance(noise);
  constraint.information = noisy_information(drift + covariance.unmatched, 0, 0);
  constraint.doubt = (kPathDoubt * kPathDoubt - 1) * drift;
  graph.add_constraint(constraint);
  if (begins) return;
  here.segment = before.segment;
  keyframes.in_segment = covariance;
}

void set_reference(LoopRecord& loop, const KeyframeStore& keyframes) {
  const PlacedLocalMap& local_map = keyframes.local_maps[loop.local_map];
  const mrpt::math::TPose2D& local_T_anchor = keyframes.nodes[local_map.anchor].local_T_robot;
  const mrpt::math::TPose2D local_T_node = compose(local_T_anchor, loop.anchor_T_node);
  std::size_t nearest = local_map.anchor;
  double nearest_m = distance_m(local_T_anchor, local_T_node);
  for (std::size_t node = local_map.first_node; node <= local_map.last_node; ++node) {
    if (node == loop.node) continue;  // a match by hand, with a local map that holds the scan itself
    const double apart_m = distance_m(keyframes.nodes[node].local_T_robot, local_T_node);
    if (apart_m >= nearest_m) continue;
    nearest_m = apart_m;
    nearest = node;
  }
  const std::size_t segment = keyframes.nodes[nearest].segment;
  loop.reference = segment == keyframes.nodes[loop.node].segment ? nearest : segment;
  loop.reference_T_node = between(keyframes.nodes[loop.reference].local_T_robot, local_T_node);
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
