// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/shared_errors.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "frames/pose_operations.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/marginal_covariance.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Standard deviation of the poses of nodes in a stretch without any constraint of a local map: the stretch is
// rigid. In metres and radians.
constexpr double kRigidSigma = 1e-3;

Matrix3d inverse_of(const Matrix3d& matrix) {
  const Matrix3d inverse = matrix.inverse();
  if (!inverse.allFinite())
    throw UserError(
        "the information matrix of a constraint of the pose graph is singular, so its covariance is unknown. "
        "Give each constraint of a local map and each loop information about x, y and the heading.");
  return (inverse + inverse.transpose()) / 2;
}

// Multiplies the variance of the position by a factor.
Matrix3d with_scaled_position(const Matrix3d& covariance, double factor) {
  const Vector3d scale(std::sqrt(factor), std::sqrt(factor), 1);
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

// Numbers of the enabled constraints that place a node in local maps.
std::vector<std::size_t> memberships(const PoseGraph& graph, std::size_t node) {
  std::vector<std::size_t> found;
  for (const std::uint32_t i : graph.constraints_of(node))
    if (graph.enabled(i) && graph.constraint(i).kind == Constraint::Kind::kLocalMap &&
        graph.constraint(i).to == node)
      found.push_back(i);
  return found;
}

// Returns the mean covariance of a node in its local maps, in the axes of the map. Empty without memberships.
std::optional<Matrix3d> covariance_in_maps(const PoseGraph& graph,
                                           const std::vector<std::size_t>& memberships) {
  if (memberships.empty()) return std::nullopt;
  Matrix3d information = Matrix3d::Zero();
  for (const std::size_t i : memberships)
    information += in_turned_axes(graph.constraint(i).information, graph.pose(graph.constraint(i).from).phi);
  return inverse_of(information / static_cast<double>(memberships.size()));
}

// The drift is a random walk. Its variance over a whole local map is twice the stated variance, which is
// about that in the middle of the map. Half of this variance grows with the path, the other half with the
// number of nodes, because a robot that turns on the spot drifts too. `placed` is the covariance of the node
// at the end of the step in its local maps.
Matrix3d drift_of_step(double step_m, const Matrix3d& placed, const MeanLocalMap& mean,
                       const SharedErrorOptions& options) {
  return with_scaled_position((step_m / std::max(mean.travel_m, 1e-3) + 1 / mean.nodes) * placed,
                              options.drift_position_factor);
}

class SharedErrors {
 public:
  SharedErrors(const PoseGraph& graph, const SharedErrorOptions& options);

  PoseGraph model();
  const MeanLocalMap& mean_local_map() const { return mean_; }

 private:
  void divide_path();
  void measure_local_maps();
  void add_scans();
  void add_drift();
  void add_loops();
  void add_independent_constraints();
  std::size_t nearest_member(const Constraint& loop) const;
  void link(std::size_t from, std::size_t to, const Matrix3d& covariance_in_map);

  /// Node of the model that is a stretch.
  std::size_t node_of(std::size_t stretch) const { return graph_.num_nodes() + stretch; }

  const PoseGraph& graph_;
  const SharedErrorOptions options_;
  std::vector<std::vector<std::size_t>> memberships_;  // of each node
  std::vector<std::vector<std::size_t>> members_;      // nodes of the local map of each anchor
  /// Covariance of each node in its local maps, in the axes of the map; empty if no local map holds the node.
  std::vector<std::optional<Matrix3d>> placed_;
  std::vector<double> travelled_m_;  // to each node
  MeanLocalMap mean_;
  std::vector<std::size_t> stretch_of_;  // of each node
  std::vector<std::size_t> middles_;     // middle node of each stretch
  PoseGraph model_;
};

SharedErrors::SharedErrors(const PoseGraph& graph, const SharedErrorOptions& options)
    : graph_(graph), options_(options) {
  members_.resize(graph.num_nodes());
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    memberships_.push_back(memberships(graph, node));
    placed_.push_back(covariance_in_maps(graph, memberships_.back()));
    travelled_m_.push_back(
        node == 0 ? 0 : travelled_m_.back() + distance_m(graph.pose(node - 1), graph.pose(node)));
    for (const std::size_t i : memberships_.back()) members_[graph.constraint(i).from].push_back(node);
  }
  measure_local_maps();
}

PoseGraph SharedErrors::model() {
  divide_path();
  for (const mrpt::math::TPose2D& pose : graph_.poses()) model_.add_node(pose);
  for (const std::size_t middle : middles_) model_.add_node(graph_.pose(middle));
  if (graph_.root() != 0) model_.set_root(graph_.root());
  add_independent_constraints();
  add_scans();
  add_drift();
  add_loops();
  return std::move(model_);
}

// A stretch ends after its length, and before a node that no local map holds, which begins a run.
void SharedErrors::divide_path() {
  std::vector<std::size_t> first;
  for (std::size_t node = 0; node < graph_.num_nodes(); ++node) {
    if (node == 0 || !placed_[node] || travelled_m_[node] - travelled_m_[first.back()] >= options_.stretch_m)
      first.push_back(node);
    stretch_of_.push_back(first.size() - 1);
  }
  for (std::size_t stretch = 0; stretch < first.size(); ++stretch) {
    const std::size_t end = stretch + 1 < first.size() ? first[stretch + 1] : graph_.num_nodes();
    middles_.push_back((first[stretch] + end - 1) / 2);
  }
}

void SharedErrors::measure_local_maps() {
  double local_maps = 0;
  for (std::size_t anchor = 0; anchor < graph_.num_nodes(); ++anchor) {
    if (members_[anchor].empty()) continue;
    local_maps += 1;
    mean_.nodes += static_cast<double>(members_[anchor].size());
    mean_.travel_m += std::abs(travelled_m_[members_[anchor].back()] - travelled_m_[anchor]);
  }
  mean_.nodes /= std::max(local_maps, 1.0);
  mean_.travel_m /= std::max(local_maps, 1.0);
}

/// Adds a constraint that agrees with the poses. The covariance is in the axes of the map.
void SharedErrors::link(std::size_t from, std::size_t to, const Matrix3d& covariance_in_map) {
  Constraint constraint;
  constraint.kind = Constraint::Kind::kLocalMap;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = between(model_.pose(from), model_.pose(to));
  constraint.information = inverse_of(in_turned_axes(covariance_in_map, -model_.pose(from).phi));
  model_.add_constraint(constraint);
}

void SharedErrors::add_independent_constraints() {
  for (std::size_t i = 0; i < graph_.num_constraints(); ++i) {
    Constraint constraint = graph_.constraint(i);
    if (!graph_.enabled(i) || constraint.kind == Constraint::Kind::kLocalMap ||
        constraint.kind == Constraint::Kind::kLoop)
      continue;
    constraint.from_T_to = between(graph_.pose(constraint.from), graph_.pose(constraint.to));
    if (constraint.kind == Constraint::Kind::kKnown) constraint.information /= weight_of_known(constraint);
    model_.add_constraint(constraint);
  }
}

void SharedErrors::add_scans() {
  for (std::size_t begin = 0, end = 0; begin < graph_.num_nodes(); begin = end) {
    Matrix3d sum = Matrix3d::Zero();
    std::size_t placed = 0;
    for (end = begin; end < graph_.num_nodes() && stretch_of_[end] == stretch_of_[begin]; ++end) {
      if (!placed_[end]) continue;
      sum += *placed_[end];
      ++placed;
    }
    const Matrix3d own = placed == 0 ? Matrix3d(Matrix3d::Identity() * kRigidSigma * kRigidSigma)
                                     : Matrix3d(options_.scan_share * sum / static_cast<double>(placed));
    for (std::size_t node = begin; node < end; ++node) link(node_of(stretch_of_[node]), node, own);
  }
}

void SharedErrors::add_drift() {
  for (std::size_t stretch = 0; stretch + 1 < middles_.size(); ++stretch) {
    Matrix3d drift = Matrix3d::Zero();
    bool continues = true;
    for (std::size_t node = middles_[stretch] + 1; node <= middles_[stretch + 1] && continues; ++node) {
      continues = placed_[node].has_value();
      if (continues)
        drift += drift_of_step(travelled_m_[node] - travelled_m_[node - 1], *placed_[node], mean_, options_);
    }
    if (continues) link(node_of(stretch), node_of(stretch + 1), drift);
  }
}

/// Returns the node of the loop's local map that is nearest to the scan of the loop.
std::size_t SharedErrors::nearest_member(const Constraint& loop) const {
  const mrpt::math::TPose2D& scan = graph_.pose(loop.to);
  const auto distance_m2 = [&](std::size_t node) {
    const mrpt::math::TPose2D& pose = graph_.pose(node);
    return (pose.x - scan.x) * (pose.x - scan.x) + (pose.y - scan.y) * (pose.y - scan.y);
  };
  std::size_t nearest = loop.from;
  double nearest_m2 = distance_m2(nearest);
  for (const std::size_t member : members_[loop.from]) {
    const double away_m2 = distance_m2(member);
    if (away_m2 >= nearest_m2) continue;
    nearest = member;
    nearest_m2 = away_m2;
  }
  return nearest;
}

void SharedErrors::add_loops() {
  struct Loops {
    Matrix3d information = Matrix3d::Zero();  // sum, in the axes of the map
    double count = 0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Loops> between;
  for (std::size_t i = 0; i < graph_.num_constraints(); ++i) {
    const Constraint& loop = graph_.constraint(i);
    if (!graph_.enabled(i) || loop.kind != Constraint::Kind::kLoop) continue;
    const std::pair<std::size_t, std::size_t> ends =
        std::minmax<std::size_t>({stretch_of_[nearest_member(loop)], stretch_of_[loop.to]});
    if (ends.first == ends.second) continue;
    Loops& loops = between[ends];
    loops.information += in_turned_axes(loop.information, graph_.pose(loop.from).phi);
    loops.count += 1;
  }
  for (const auto& [ends, loops] : between) {
    const double share = options_.common_loop_share + (1 - options_.common_loop_share) / loops.count;
    link(node_of(ends.first), node_of(ends.second), share * inverse_of(loops.information / loops.count));
  }
}

}  // namespace

double weight_of_known(const Constraint& constraint) {
  const double width = constraint.kernel ? constraint.kernel->width / kKnownKernelWidth : 1;
  return width * width;
}

PoseGraph graph_with_shared_errors(const PoseGraph& graph, const SharedErrorOptions& options) {
  return SharedErrors(graph, options).model();
}

std::vector<Matrix3d> pose_covariances(const PoseGraph& graph, const SharedErrorOptions& options) {
  if (graph.num_nodes() == 0) return {};
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph, options));
  std::vector<Matrix3d> covariances = of_model.marginals();
  covariances.resize(graph.num_nodes());
  return covariances;
}

Matrix3d pose_covariance(const PoseGraph& graph, std::size_t node, const SharedErrorOptions& options) {
  MarginalCovariance of_model;
  of_model.update(graph_with_shared_errors(graph, options));
  return of_model.marginal(node);
}

MeanLocalMap mean_local_map(const PoseGraph& graph) {
  return SharedErrors(graph, {}).mean_local_map();
}

std::optional<Matrix3d> drift_covariance(const PoseGraph& graph, std::size_t node, const MeanLocalMap& mean,
                                         const SharedErrorOptions& options) {
  const std::optional<Matrix3d> placed = covariance_in_maps(graph, memberships(graph, node));
  if (node == 0 || !placed || mean.nodes == 0) return std::nullopt;
  return drift_of_step(distance_m(graph.pose(node - 1), graph.pose(node)), *placed, mean, options);
}

}  // namespace psi_slam
