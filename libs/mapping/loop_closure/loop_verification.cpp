// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_verification.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "logs/frames/pose_operations.h"
#include "logs/frames/position_variance.h"
#include "mapping/loop_closure/range_image.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kReverseTolerance_m = 0.25;
constexpr double kNeighbourSpacing_m = 0.3;
constexpr double kReportedShare = 0.8;  // of min_response()

// Returns the agreement of the neighbouring scans with the local map. On each side, these are the nearest one
// and those at least kNeighbourSpacing_m of distance and turn from the one before. The matched pose and
// the front end's motion place these scans. If the match is true, these scans fit the local map too.
LocalMap::Agreement neighbours_agreement(const LoopRecord& loop, const KeyframeStore& keyframes,
                                         double neighbourhood_m) {
  const LocalMap& map = *keyframes.local_maps[loop.local_map].map;
  const NodeScan& here = keyframes.nodes[loop.node];
  LocalMap::Agreement sum;
  const NodeScan* last = nullptr;
  const auto add = [&](const NodeScan& there) {
    if (!there.points) return;
    if (last != nullptr && travel_and_turn_m(last->local_T_robot, there.local_T_robot) < kNeighbourSpacing_m)
      return;
    last = &there;
    const LocalMap::Agreement one = map.agreement(
        *there.points, compose(loop.anchor_T_node, between(here.local_T_robot, there.local_T_robot)));
    sum.observed += one.observed;
    sum.hits += one.hits;
  };
  const auto near = [&](std::size_t node) {
    return std::abs(keyframes.nodes[node].travelled_m - here.travelled_m) <= neighbourhood_m;
  };
  for (std::size_t node = loop.node; node-- > 0 && near(node);) add(keyframes.nodes[node]);
  last = nullptr;
  for (std::size_t node = loop.node + 1; node < keyframes.nodes.size() && near(node); ++node)
    add(keyframes.nodes[node]);
  return sum;
}

// Returns the agreement of scans in the local map with the scan of the loop's node. Uses the node nearest to
// the matched pose, and up to three nodes before and after it.
RangeImage::Agreement reverse_agreement(const LoopRecord& loop, const KeyframeStore& keyframes) {
  const PlacedLocalMap& local_map = keyframes.local_maps[loop.local_map];
  const TPose2D& local_T_anchor = keyframes.nodes[local_map.anchor].local_T_robot;
  std::size_t nearest = local_map.first_node;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t node = local_map.first_node; node <= local_map.last_node; ++node) {
    const TPose2D anchor_T_other = between(local_T_anchor, keyframes.nodes[node].local_T_robot);
    const double apart_m = distance_m(loop.anchor_T_node, anchor_T_other);
    if (apart_m < nearest_m) nearest_m = apart_m, nearest = node;
  }
  const RangeImage image(*keyframes.nodes[loop.node].points);
  RangeImage::Agreement sum;
  const std::size_t first = std::max(local_map.first_node, nearest < 3 ? 0 : nearest - 3);
  const std::size_t last = std::min(local_map.last_node, nearest + 3);
  for (std::size_t node = first; node <= last; ++node) {
    const TPose2D anchor_T_other = between(local_T_anchor, keyframes.nodes[node].local_T_robot);
    const RangeImage::Agreement one = image.compare(
        *keyframes.nodes[node].points, between(loop.anchor_T_node, anchor_T_other), kReverseTolerance_m);
    sum.agree += one.agree;
    sum.contradict += one.contradict;
  }
  return sum;
}

/// Returns the first reason to reject the loop, if any. Sets the shares that were computed for the decision.
std::optional<LoopRejection> find_objection(LoopRecord& loop, const ScanPoints& scan,
                                            const KeyframeStore& keyframes,
                                            const LoopVerificationOptions& options) {
  using Reason = LoopRejection::Reason;
  const bool wide = is_wide(loop.window, options);
  const double needed = min_response(loop.window, options);
  if (loop.response < needed) return LoopRejection{Reason::kLowResponse, loop.response, needed};
  // Far from the prediction, another peak or a place outside the window is more probable.
  const double doubt = 1 - (1 - loop.ambiguity) * loop.prior;
  if (!wide && doubt > options.max_ambiguity)
    return LoopRejection{Reason::kAmbiguous, doubt, options.max_ambiguity};
  const double sigma_m = std::sqrt(largest_position_variance_m2(loop.covariance));
  if (sigma_m > options.max_sigma_m)
    return LoopRejection{Reason::kUncertainPosition, sigma_m, options.max_sigma_m};

  const LocalMap::Agreement own =
      keyframes.local_maps[loop.local_map].map->agreement(scan, loop.anchor_T_node);
  loop.observed_share = static_cast<double>(own.observed) / static_cast<double>(scan.points.size());
  if (!wide && loop.observed_share < options.min_observed_share)
    return LoopRejection{Reason::kUnobserved, loop.observed_share, options.min_observed_share};

  loop.neighbours_agree = neighbours_agreement(loop, keyframes, options.neighbourhood_m).share();
  if (loop.neighbours_agree < options.min_neighbours_agree)
    return LoopRejection{Reason::kNeighboursDisagree, loop.neighbours_agree, options.min_neighbours_agree};

  loop.reverse_agree = reverse_agreement(loop, keyframes).share();
  if (loop.reverse_agree < options.min_reverse_agree)
    return LoopRejection{Reason::kReverseDisagrees, loop.reverse_agree, options.min_reverse_agree};
  return std::nullopt;
}

}  // namespace

bool is_wide(const SearchExtent& extent, const LoopVerificationOptions& options) {
  return std::max(extent.x_m, extent.y_m) > options.wide_window_m;
}

double min_response(const SearchExtent& extent, const LoopVerificationOptions& options) {
  return is_wide(extent, options) ? options.min_context_response : options.min_response;
}

double least_reported_response(const SearchExtent& extent, const LoopVerificationOptions& options) {
  return (is_wide(extent, options) ? 1 : kReportedShare) * min_response(extent, options);
}

double least_response_by_hand(const SearchExtent& extent, const LoopVerificationOptions& options) {
  return kReportedShare * min_response(extent, options);
}

void verify(LoopRecord& loop, const ScanPoints& scan, const KeyframeStore& keyframes,
            const LoopVerificationOptions& options) {
  loop.rejection = find_objection(loop, scan, keyframes, options);
  if (loop.rejection)
    loop.state = LoopState::kRejected;
  else
    loop.state = is_wide(loop.window, options) ? LoopState::kCandidate : LoopState::kAccepted;
}

}  // namespace psi_slam
