// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_candidates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A path of 29 m along x and back, with the way back one metre to the left of the way out. There is a node
// every metre, a path segment every five nodes and a local map every ten nodes.
struct ThereAndBack {
  KeyframeStore keyframes;
  PoseGraph graph;

  ThereAndBack() {
    for (std::size_t i = 0; i < 60; ++i) {
      const double along = static_cast<double>(i);
      NodeScan node;
      node.frame = i;
      node.local_T_robot = i < 30 ? TPose2D(along, 0, 0) : TPose2D(59 - along, 1, M_PI);
      node.travelled_m = along;
      node.segment = i / 5 * 5;
      keyframes.nodes.push_back(node);
      graph.add_node(node.local_T_robot);
    }
    for (std::size_t m = 0; m < 6; ++m) {
      PlacedLocalMap local_map;
      local_map.id = m;
      local_map.anchor = local_map.first_node = 10 * m;
      local_map.last_node = 10 * m + 9;
      keyframes.local_maps.push_back(local_map);
    }
  }

  std::vector<LoopCandidate> candidates(std::size_t node, const PositionSigma& sigma,
                                        const LoopCandidateOptions& options = {}) const {
    return loop_candidates(node, keyframes, graph, options, [&](const std::vector<std::size_t>& segments) {
      return std::vector<PositionSigma>(segments.size(), sigma);
    });
  }
  std::vector<std::size_t> local_maps(std::size_t node, const PositionSigma& sigma,
                                      const LoopCandidateOptions& options = {}) const {
    std::vector<std::size_t> result;
    for (const LoopCandidate& candidate : candidates(node, sigma, options))
      result.push_back(candidate.local_map);
    return result;
  }
};

using Maps = std::vector<std::size_t>;
using Nodes = std::vector<std::size_t>;

TEST(LoopCandidates, of_a_run_at_an_unknown_place_are_within_the_run_or_the_whole_map) {
  ThereAndBack drive;
  drive.keyframes.unplaced.push_back({30});
  EXPECT_EQ(drive.local_maps(59, {0.01, 0.001}), Maps()) << "the map beside the node has another place";
  const auto whole = whole_map_candidates(59, drive.keyframes, drive.graph, {});
  ASSERT_EQ(whole.size(), 3U);
  for (const LoopCandidate& candidate : whole) {
    EXPECT_EQ(candidate.extent.theta_rad, M_PI);
    EXPECT_GE(candidate.extent.x_m, 4.5 + LoopCandidateOptions().reach_m);
  }
}

TEST(LoopCandidates, only_local_maps_near_the_node_are_tried) {
  const ThereAndBack drive;
  EXPECT_EQ(drive.local_maps(59, {0.01, 0.001}), Maps({0}));     // node at x = 0
  EXPECT_EQ(drive.local_maps(53, {0.01, 0.001}), Maps({0, 1}));  // node at x = 6
  EXPECT_EQ(drive.local_maps(44, {0.01, 0.001}), Maps({1, 2}));  // node at x = 15: 6.1 m from local map 0
}

TEST(LoopCandidates, an_uncertain_node_may_see_farther_local_maps) {
  const ThereAndBack drive;
  EXPECT_EQ(drive.local_maps(59, {1, 0.001}), Maps({0})) << "within 9 m of x = 0";
  EXPECT_EQ(drive.local_maps(59, {1.5, 0.001}), Maps({0, 1, 4})) << "within 11 m of x = 0";
  EXPECT_EQ(drive.local_maps(59, {1000, 0.001}), Maps({0, 1, 4})) << "never beyond 13 m";
}

TEST(LoopCandidates, asks_for_the_uncertainty_of_local_maps_in_reach_only) {
  const ThereAndBack drive;
  LoopCandidateOptions oblong;
  oblong.max_window = {2, 7, 0.5};
  for (const LoopCandidateOptions& options : {LoopCandidateOptions(), oblong}) {
    for (std::size_t node = 0; node < 60; ++node) {
      Maps asked;
      loop_candidates(node, drive.keyframes, drive.graph, options, [&](const Nodes& segments) {
        EXPECT_TRUE(asked.empty()) << "the uncertainties are computed only once";
        for (const std::size_t segment : segments) asked.push_back(segment / 10);
        return std::vector<PositionSigma>(segments.size());
      });
      EXPECT_EQ(asked, drive.local_maps(node, {1000, 10}, options)) << "candidates with the largest window";
    }
  }
}

TEST(LoopCandidates, asks_for_the_segments_nearest_to_the_node) {
  const ThereAndBack drive;
  Nodes asked;
  // Node 53 is at x = 6. Local map 0 has segments from x = 0 and 5, local map 1 from x = 10 and 15.
  loop_candidates(53, drive.keyframes, drive.graph, {}, [&](const Nodes& segments) {
    asked = segments;
    return std::vector<PositionSigma>(segments.size());
  });
  EXPECT_EQ(asked, Nodes({5, 10}));
}

TEST(LoopCandidates, each_local_map_has_its_own_uncertainty) {
  const ThereAndBack drive;
  std::vector<PositionSigma> sigma(60, {0.01, 0.001});
  sigma[5] = {0.5, 0.05};
  sigma[10] = {0.8, 0.08};
  const auto candidates = loop_candidates(53, drive.keyframes, drive.graph, {}, [&](const Nodes& segments) {
    std::vector<PositionSigma> chosen;
    for (const std::size_t segment : segments) chosen.push_back(sigma[segment]);
    return chosen;
  });
  ASSERT_EQ(candidates.size(), 2U);
  EXPECT_NEAR(candidates[0].extent.x_m, 2, 1e-12);
  EXPECT_NEAR(candidates[0].extent.theta_rad, 0.2, 1e-12);
  EXPECT_NEAR(candidates[1].extent.x_m, 3.2, 1e-12);
  EXPECT_NEAR(candidates[1].extent.theta_rad, 0.32, 1e-12);
}

TEST(LoopCandidates, the_window_covers_four_sigmas_within_its_bounds) {
  const ThereAndBack drive;
  const LoopCandidateOptions options;
  const auto window = [&](double metres, double radians) {
    const auto candidates = drive.candidates(59, {metres, radians});
    return candidates.empty() ? SearchExtent() : candidates.front().extent;
  };
  EXPECT_EQ(window(0.001, 0.0001).x_m, options.min_window_m);
  EXPECT_EQ(window(0.001, 0.0001).y_m, options.min_window_m);
  EXPECT_EQ(window(0.001, 0.0001).theta_rad, options.min_window_rad);
  EXPECT_NEAR(window(1.2, 0.1).x_m, 4.8, 1e-12);
  EXPECT_NEAR(window(1.2, 0.1).y_m, 4.8, 1e-12);
  EXPECT_NEAR(window(1.2, 0.1).theta_rad, 0.4, 1e-12);
  EXPECT_EQ(window(50, 2).x_m, options.max_window.x_m);
  EXPECT_EQ(window(50, 2).y_m, options.max_window.y_m);
  EXPECT_EQ(window(50, 2).theta_rad, options.max_window.theta_rad);
}

TEST(LoopCandidates, state_the_uncertainty_that_the_window_covers) {
  const LoopCandidateOptions options;
  const ThereAndBack path;
  for (const double sigma_m : {0.001, 0.4}) {
    const std::vector<LoopCandidate> found = path.candidates(45, {sigma_m, 0.01});
    ASSERT_FALSE(found.empty());
    for (const LoopCandidate& one : found)
      EXPECT_NEAR(options.window_sigmas * one.sigma_m, one.extent.x_m, 1e-12) << sigma_m;
  }
}

TEST(PathPrior, falls_with_the_distance_in_standard_deviations) {
  EXPECT_EQ(path_prior(0, 0.1), 1);
  EXPECT_NEAR(path_prior(0.25, 0.1), std::exp(-0.5), 1e-9);
  EXPECT_NEAR(path_prior(2.5, 1), std::exp(-0.5), 1e-9);
  EXPECT_EQ(path_prior(5, std::numeric_limits<double>::infinity()), 1) << "no prediction";
}

TEST(LoopCandidates, an_unconnected_node_is_searched_in_the_largest_window) {
  const ThereAndBack drive;
  const double inf = std::numeric_limits<double>::infinity();
  const auto candidates = drive.candidates(59, {inf, inf});
  ASSERT_FALSE(candidates.empty());
  EXPECT_EQ(candidates.front().extent.x_m, LoopCandidateOptions().max_window.x_m);
  EXPECT_EQ(candidates.front().extent.theta_rad, LoopCandidateOptions().max_window.theta_rad);
}

TEST(LoopCandidates, both_bounds_of_an_oblong_window_hold) {
  const ThereAndBack drive;
  for (const SearchExtent& bounds : {SearchExtent{4, 2, 0.2}, SearchExtent{2, 4, 0.2}}) {
    LoopCandidateOptions options;
    options.max_window = bounds;
    const auto candidates = drive.candidates(59, {10, 1}, options);
    ASSERT_EQ(candidates.size(), 1U) << "within 5 m + 4 m of x = 0";
    EXPECT_EQ(candidates.front().extent.x_m, bounds.x_m);
    EXPECT_EQ(candidates.front().extent.y_m, bounds.y_m);
    EXPECT_EQ(candidates.front().extent.theta_rad, bounds.theta_rad);
  }
}

TEST(LoopCandidates, local_maps_of_the_path_nearby_are_left_out) {
  const ThereAndBack drive;
  LoopCandidateOptions options;
  options.reach_m = 100;
  options.min_travel_m = 10;
  EXPECT_EQ(drive.local_maps(18, {0.01, 0.001}, options), Maps({3, 4, 5}))
      << "9 m after map 0, 2 m before map 2";
  EXPECT_EQ(drive.local_maps(19, {0.01, 0.001}, options), Maps({0, 3, 4, 5})) << "10 m after map 0";
  EXPECT_EQ(drive.local_maps(20, {0.01, 0.001}, options), Maps({0, 3, 4, 5})) << "10 m before map 3";
  EXPECT_EQ(drive.local_maps(21, {0.01, 0.001}, options), Maps({0, 4, 5})) << "9 m before map 3";
  options.min_travel_m = 0;
  EXPECT_EQ(drive.local_maps(18, {0.01, 0.001}, options), Maps({0, 1, 2, 3, 4, 5}));
}

TEST(LoopCandidates, predicts_from_the_graph) {
  ThereAndBack drive;
  drive.graph.set_pose(0, {1, 2, M_PI / 2});  // moves poses of the graph, but not the front end's frame
  drive.graph.set_pose(59, {2, 5, M_PI});
  const auto candidates = drive.candidates(59, {0.01, 0.001});
  ASSERT_EQ(candidates.size(), 1U);
  EXPECT_NEAR(candidates[0].anchor_T_node.x, 3, 1e-12);
  EXPECT_NEAR(candidates[0].anchor_T_node.y, -1, 1e-12);
  EXPECT_NEAR(candidates[0].anchor_T_node.phi, M_PI / 2, 1e-12);
  EXPECT_NEAR(candidates[0].distance_m, std::hypot(1, 3), 1e-9) << "the local map's node moved to (1, 2)";
}

// Far candidates of node 59 whose position has this standard deviation relative to all segments.
std::vector<LoopCandidate> far_of_node_59(double sigma_m, const LoopCandidateOptions& options) {
  const ThereAndBack drive;
  return far_candidates(59, drive.keyframes, drive.graph, options, [&](const Nodes& segments) {
    return std::vector<PositionSigma>(segments.size(), {sigma_m, 0.1});
  });
}

Maps far_maps_of_node_59(double sigma_m, const LoopCandidateOptions& options) {
  Maps result;
  for (const LoopCandidate& far : far_of_node_59(sigma_m, options)) result.push_back(far.local_map);
  return result;
}

TEST(FarCandidates, are_searched_only_if_the_uncertainty_exceeds_the_largest_window) {
  const LoopCandidateOptions options;  // four standard deviations, and windows of 8 m
  EXPECT_TRUE(far_of_node_59(1.99, options).empty());
  EXPECT_FALSE(far_of_node_59(2.01, options).empty());
}

TEST(FarCandidates, are_the_local_maps_within_uncertainty_and_reach) {
  LoopCandidateOptions options;
  options.reach_m = 2;
  // Node 59 is at x = 0, y = 1. The local maps 0, 1 and 2 begin at x = 0, 10 and 20, at y = 0. Local map 4
  // ends at x = 10, y = 1. Local map 5 holds the node.
  EXPECT_EQ(far_maps_of_node_59(2.01, options), Maps({0, 4}));
  EXPECT_EQ(far_maps_of_node_59(5, options), Maps({0, 1, 2, 3, 4}));
  EXPECT_EQ(far_maps_of_node_59(std::numeric_limits<double>::infinity(), options), Maps({0, 1, 2, 3, 4}));
}

TEST(FarCandidates, ask_once_for_the_nearest_segment_of_each_local_map) {
  const ThereAndBack drive;
  LoopCandidateOptions options;
  options.min_travel_m = 11;  // local map 4 ends 10 m before node 59
  Nodes asked;
  const auto far = far_candidates(59, drive.keyframes, drive.graph, options, [&](const Nodes& segments) {
    EXPECT_TRUE(asked.empty()) << "asks once";
    asked = segments;
    std::vector<PositionSigma> sigmas(segments.size(), {0.1, 0.1});
    sigmas[1] = {100, 0.1};  // only of local map 1
    return sigmas;
  });
  EXPECT_EQ(asked, Nodes({0, 10, 20, 35}));
  ASSERT_EQ(far.size(), 1U);
  EXPECT_EQ(far[0].local_map, 1U);
  EXPECT_NEAR(far[0].distance_m, std::hypot(10, 1), 1e-9);
}

TEST(FarCandidates, keep_the_prediction_of_the_path) {
  const ThereAndBack drive;
  const std::vector<LoopCandidate> candidates = far_of_node_59(3, {});
  ASSERT_FALSE(candidates.empty());
  for (const LoopCandidate& far : candidates) {
    const std::size_t anchor = drive.keyframes.local_maps[far.local_map].anchor;
    EXPECT_EQ(far.anchor_T_predicted, drive.graph.pose(59) - drive.graph.pose(anchor));
    EXPECT_EQ(far.sigma_m, 3);
  }
}

TEST(FarCandidates, have_windows_that_hold_all_places_near_the_local_map) {
  const ThereAndBack drive;
  const LoopCandidateOptions options;
  const std::vector<LoopCandidate> candidates = far_of_node_59(100, options);
  ASSERT_FALSE(candidates.empty());
  for (const LoopCandidate& far : candidates) {
    const PlacedLocalMap& local_map = drive.keyframes.local_maps[far.local_map];
    for (std::size_t node = local_map.first_node; node <= local_map.last_node; ++node) {
      const TPose2D anchor_T_node = drive.graph.pose(node) - drive.graph.pose(local_map.anchor);
      EXPECT_LE(std::abs(anchor_T_node.x - far.anchor_T_node.x) + options.reach_m, far.extent.x_m + 1e-9);
      EXPECT_LE(std::abs(anchor_T_node.y - far.anchor_T_node.y) + options.reach_m, far.extent.y_m + 1e-9);
    }
    EXPECT_EQ(far.extent.theta_rad, options.max_window.theta_rad);
  }
}

}  // namespace
}  // namespace psi_slam
