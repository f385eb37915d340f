// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/covariance_check.h"

#include <Eigen/LU>
#include <algorithm>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "base/random_draws.h"
#include "logs/frames/pose_operations.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "pose_graph/constraint_error.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/path_covariance.h"
#include "pose_graph/shared_errors.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Numbers of first and second nodes of the random pairs. Several second nodes for one first node cost little
// more than a single one.
constexpr std::size_t kFirsts = 30;
constexpr std::size_t kOthers = 20;
// Nodes closer than this many nodes to each other on the path are neighbours.
constexpr std::size_t kNeighbours = 100;

/// True pose of node b in the frame of node a.
using TruePose = std::function<TPose2D(std::size_t a, std::size_t b)>;

struct PairSquares {
  std::vector<double> whole_graph;
  std::vector<double> best_path;
};

PairSquares squares_of_pairs(const PoseGraph& graph, const TruePose& a_T_b, std::uint64_t seed) {
  MarginalCovariance of_graph;
  of_graph.update(graph);
  PathCovarianceSearch of_path;
  PathCovarianceOptions doubtful;
  doubtful.with_doubt = true;
  RandomDraws random(seed, "pairs of nodes", 0);
  PairSquares squares;
  for (std::size_t i = 0; i < kFirsts; ++i) {
    const std::size_t a = random.index(graph.num_nodes());
    std::vector<std::size_t> others;
    while (others.size() < kOthers)
      if (const std::size_t b = random.index(graph.num_nodes()); b != a) others.push_back(b);
    const std::vector<Eigen::Matrix3d> covariances = of_graph.relative(a, others);
    of_path.run(graph, a, doubtful);
    for (std::size_t k = 0; k < others.size(); ++k) {
      const TPose2D found = between(graph.pose(a), graph.pose(others[k]));
      const TPose2D true_pose = a_T_b(a, others[k]);
      squares.whole_graph.push_back(normalised_square(found, true_pose, covariances[k].inverse()));
      const RelativeUncertainty along_path = of_path.of(others[k]);
      if (along_path.reached)
        squares.best_path.push_back(normalised_square(found, true_pose, along_path.covariance.inverse()));
    }
  }
  return squares;
}

struct ModelSquares {
  std::vector<double> pairs;
  std::vector<double> neighbours;
  std::vector<double> to_first;
};

/// Squares of the poses of a map by the model of shared errors.
ModelSquares squares_by_model(const PoseGraph& graph, const TruePose& a_T_b, std::uint64_t seed) {
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph));
  RandomDraws random(seed, "nodes for the model of shared errors", 0);
  const auto add = [&](std::size_t a, const std::vector<std::size_t>& others, std::vector<double>& squares) {
    const std::vector<Eigen::Matrix3d> covariances = of_model.relative(a, others);
    for (std::size_t k = 0; k < others.size(); ++k)
      squares.push_back(normalised_square(between(graph.pose(a), graph.pose(others[k])), a_T_b(a, others[k]),
                                          covariances[k].inverse()));
  };
  ModelSquares squares;
  std::vector<std::size_t> of_first;
  for (std::size_t i = 0; i < kFirsts; ++i) {
    const std::size_t a = random.index(graph.num_nodes());
    std::vector<std::size_t> others;
    std::vector<std::size_t> neighbours;
    while (others.size() < kOthers) {
      if (const std::size_t b = random.index(graph.num_nodes()); b != a) others.push_back(b);
      const std::size_t next = a + 1 + random.index(kNeighbours);
      if (next < graph.num_nodes()) neighbours.push_back(next);
      of_first.push_back(1 + random.index(graph.num_nodes() - 1));
    }
    add(a, others, squares.pairs);
    add(a, neighbours, squares.neighbours);
  }
  add(graph.root(), of_first, squares.to_first);
  return squares;
}

}  // namespace

double normalised_square(const TPose2D& measured, const TPose2D& truth, const Eigen::Matrix3d& information) {
  const Eigen::Vector3d error = constraint_error(measured, RotatedPose(TPose2D(0, 0, 0)), RotatedPose(truth));
  return error.dot(information * error);
}

NormalisedErrors normalised_errors(std::string of, std::vector<double> squares) {
  NormalisedErrors errors;
  errors.of = std::move(of);
  errors.count = squares.size();
  if (squares.empty()) return errors;
  const auto count = static_cast<double>(squares.size());
  errors.mean = std::accumulate(squares.begin(), squares.end(), 0.0) / count / 3;
  const auto beyond =
      std::count_if(squares.begin(), squares.end(), [](double s) { return s > kChiSquare95; });
  errors.beyond_95 = static_cast<double>(beyond) / count;
  const auto middle = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  errors.median = *middle / kChiSquareMedian;
  return errors;
}

std::vector<NormalisedErrors> check_covariances(const MappingResult& result, const Trajectory& truth,
                                                std::uint64_t seed) {
  PoseGraph graph = result.graph;
  const TruePose a_T_b = [&](std::size_t a, std::size_t b) {
    return between(truth[result.node_frames[a]].pose, truth[result.node_frames[b]].pose);
  };
  std::set<std::pair<std::size_t, std::size_t>> loops;
  for (const LoopRecord& loop : result.loops)
    if (loop.state == LoopState::kAccepted) loops.emplace(loop.reference, loop.node);
  std::vector<double> of_maps;
  std::vector<double> of_loops;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const Constraint& constraint = graph.constraint(i);
    const bool is_loop = loops.count({constraint.from, constraint.to}) != 0;
    (is_loop ? of_loops : of_maps)
        .push_back(normalised_square(constraint.from_T_to, a_T_b(constraint.from, constraint.to),
                                     constraint.information));
  }
  std::vector<NormalisedErrors> errors = {normalised_errors("scans in local maps", std::move(of_maps)),
                                          normalised_errors("loops", std::move(of_loops))};
  if (graph.num_nodes() > 1) {
    SparsePoseAdjustment().optimize(graph);  // covariances are defined at the optimum
    PairSquares squares = squares_of_pairs(graph, a_T_b, seed);
    errors.push_back(normalised_errors("any two nodes, by the best path", std::move(squares.best_path)));
    errors.push_back(normalised_errors("any two nodes, by the whole graph with independent constraints",
                                       std::move(squares.whole_graph)));
    ModelSquares model = squares_by_model(result.graph, a_T_b, seed);
    errors.push_back(normalised_errors("any two nodes, by the whole graph", std::move(model.pairs)));
    errors.push_back(normalised_errors(
        "nodes within " + std::to_string(kNeighbours) + " nodes on the path, by the whole graph",
        std::move(model.neighbours)));
    errors.push_back(
        normalised_errors("nodes relative to the first, by the whole graph", std::move(model.to_first)));
  }
  return errors;
}

}  // namespace psi_slam
