// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/incremental_pose_adjustment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::uint32_t kNoVariable = NodeStar::kNoVariable;
// The whole graph is solved when it has grown by this share of its nodes since the last complete solution.
constexpr double kGrowthBetweenCompleteSolutions = 0.2;
// Leaves are moved when a core node has moved by more than this.
constexpr double kPlacing_m = 5e-4;
constexpr double kPlacing_rad = 5e-5;

constexpr int kMaxIterations = 10;
// Further steps wait for the next call if the last step lowered E by less than this share.
constexpr double kNegligibleDecrease = 1e-4;
// The linearisation is poor if E after a step exceeds the predicted E by this factor.
constexpr double kPoorPrediction = 10;
// E may rise by this share of E, because constraints are not linearised exactly where they are.
constexpr double kToleratedRise = 1e-3;

bool is_noticeable(const RotatedPose& from, const RotatedPose& to) {
  return std::abs(to.x - from.x) > kPlacing_m || std::abs(to.y - from.y) > kPlacing_m ||
         std::abs(wrap_to_pi(to.theta - from.theta)) > kPlacing_rad;
}

}  // namespace

bool IncrementalPoseAdjustment::is_leaf(std::uint32_t node) const {
  return variable_of_[node] == kNoVariable && node != root_;
}

// Returns whether only nodes and constraints were added since the last call.
bool IncrementalPoseAdjustment::continues(const PoseGraph& graph) const {
  if (poses_.empty() || graph.root() != root_) return false;
  if (graph.num_nodes() < poses_.size() || graph.num_constraints() < enabled_.size()) return false;
  for (std::size_t i = 0; i < enabled_.size(); ++i)
    if (graph.enabled(i) != (enabled_[i] != 0)) return false;
  return std::equal(poses_.begin(), poses_.end(), graph.poses().begin(),
                    [](const RotatedPose& known, const TPose2D& pose) {
                      return known.x == pose.x && known.y == pose.y && known.theta == pose.phi;
                    });
}

// Adds the new nodes and constraints. Returns false if a new node is not linked to an earlier node.
bool IncrementalPoseAdjustment::add_news(const PoseGraph& graph) {
  const auto first_new = static_cast<std::uint32_t>(poses_.size());
  for (auto node = first_new; node < graph.num_nodes(); ++node) {
    poses_.emplace_back(graph.pose(node));
    stars_.emplace_back(node);
    costs_.push_back(0);
    is_retired_.push_back(1);
    if (node != root_) retired_.push_back(node);
    is_moved_.push_back(0);
    variable_of_.push_back(kNoVariable);
  }
  for (auto index = static_cast<std::uint32_t>(enabled_.size()); index < graph.num_constraints(); ++index) {
    enabled_.push_back(graph.enabled(index) ? 1 : 0);
    if (graph.enabled(index)) add_constraint(graph, index);
  }
  for (auto node = first_new; node < graph.num_nodes(); ++node) {
    const auto& constraints = graph.constraints_of(node);
    const bool is_linked =
        node == 0 || std::any_of(constraints.begin(), constraints.end(), [&](std::uint32_t index) {
          const Constraint& constraint = graph.constraint(index);
          return graph.enabled(index) && std::min(constraint.from, constraint.to) < node;
        });
    if (!is_linked) return false;
  }
  return true;
}

void IncrementalPoseAdjustment::add_constraint(const PoseGraph& graph, std::uint32_t index) {
  const auto from = static_cast<std::uint32_t>(graph.constraint(index).from);
  const auto to = static_cast<std::uint32_t>(graph.constraint(index).to);
  // The star of a leaf sets the sine and cosine of the leaf only if a constraint begins there.
  if (is_leaf(from)) poses_[from] = RotatedPose({poses_[from].x, poses_[from].y, poses_[from].theta});
  if (is_leaf(from) && is_leaf(to)) make_core(from, graph);
  std::uint32_t centre = std::max(from, to);
  if (is_leaf(from)) centre = from;
  if (is_leaf(to)) centre = to;
  if (centre == root_) centre = std::min(from, to);
  const std::uint32_t other = centre == from ? to : from;
  retire(centre, graph);
  stars_[centre].add(graph, index);
  if (other != root_) core_[variable_of_[other]].stars.push_back(centre);
}

// Makes a leaf a core node.
void IncrementalPoseAdjustment::make_core(std::uint32_t node, const PoseGraph& graph) {
  retire(node, graph);
  variable_of_[node] = equations_.add_variable();
  core_.push_back({node, {node}, poses_[node]});
}

// Subtracts the terms of a star, which linearize() adds again.
void IncrementalPoseAdjustment::retire(std::uint32_t centre, const PoseGraph& graph) {
  if (is_retired_[centre] != 0) return;
  is_retired_[centre] = 1;
  retired_.push_back(centre);
  stars_[centre].add_to(equations_, -1, graph, poses_, variable_of_);
}

// Linearises the retired stars at the present poses. Returns false if a leaf is not determined.
bool IncrementalPoseAdjustment::linearize(const PoseGraph& graph, const PoseAdjustmentOptions& options,
                                          bool reorder) {
  for (const std::uint32_t centre : retired_) {
    if (!stars_[centre].linearize(graph, poses_, options, is_leaf(centre))) return false;
    stars_[centre].link(variable_of_, equations_);
  }
  equations_.lay_out(reorder);
  for (const std::uint32_t centre : retired_) {
    stars_[centre].add_to(equations_, 1, graph, poses_, variable_of_);
    is_retired_[centre] = 0;
  }
  return true;
}

// Takes Gauss-Newton steps until all constraints are linearised accurately. Returns false if the steps do not
// lower the error sum as predicted.
bool IncrementalPoseAdjustment::take_steps(const PoseGraph& graph, const PoseAdjustmentOptions& options,
                                           IncrementalReport& report) {
  for (const std::uint32_t centre : retired_) enter_fit(centre, graph, options);
  const double initial_cost = cost_;
  const double negligible = options.absolute_tolerance + kNegligibleDecrease * initial_cost;
  double decrease = std::numeric_limits<double>::infinity();
  while (!retired_.empty() && std::abs(decrease) > negligible && report.iterations < kMaxIterations) {
    ++report.iterations;
    if (!linearize(graph, options)) return false;
    const std::vector<std::uint32_t> linearized = std::exchange(retired_, {});
    if (!equations_.solve()) return false;
    double promised = equations_.predicted_decrease();
    for (const std::uint32_t centre : linearized) promised += stars_[centre].decrease_by_elimination();
    const double expected = std::max(cost_ - promised, negligible);
    decrease = cost_;
    move_core();
    const std::vector<std::uint32_t> moved = stars_of_moved_nodes(linearized);
    place(moved, graph, options);
    report.linearized_nodes += linearized.size();
    report.placed_nodes += moved.size();
    decrease -= cost_;
    if (!(cost_ <= kPoorPrediction * expected)) return false;  // also for NaN
  }
  return cost_ <= initial_cost * (1 + kToleratedRise) + negligible;
}

void IncrementalPoseAdjustment::move_core() {
  for (std::uint32_t variable = 0; variable < core_.size(); ++variable) {
    RotatedPose& pose = poses_[core_[variable].node];
    const Eigen::Vector3d step = equations_.step(variable);
    pose = RotatedPose({pose.x + step.x(), pose.y + step.y(), wrap_to_pi(pose.theta + step.z())});
  }
}

// Returns `stars` and all other stars with a node that has moved noticeably since its leaves were placed.
std::vector<std::uint32_t> IncrementalPoseAdjustment::stars_of_moved_nodes(std::vector<std::uint32_t> stars) {
  for (const std::uint32_t centre : stars) is_moved_[centre] = 1;
  for (CoreNode& core : core_) {
    if (!is_noticeable(core.placed, poses_[core.node])) continue;
    core.placed = poses_[core.node];
    for (const std::uint32_t centre : core.stars)
      if (std::exchange(is_moved_[centre], char{1}) == 0) stars.push_back(centre);
  }
  for (const std::uint32_t centre : stars) is_moved_[centre] = 0;
  return stars;
}

// Moves the centres that are leaves to their minima, and retires the stars that are no longer linear.
void IncrementalPoseAdjustment::place(const std::vector<std::uint32_t>& stars, const PoseGraph& graph,
                                      const PoseAdjustmentOptions& options) {
  for (const std::uint32_t centre : stars) {
    if (is_leaf(centre)) {
      poses_[centre] = stars_[centre].centre_pose(poses_);
      placed_.push_back(centre);
    }
    if (!enter_fit(centre, graph, options).is_linear) retire(centre, graph);
  }
}

NodeStar::Fit IncrementalPoseAdjustment::enter_fit(std::uint32_t centre, const PoseGraph& graph,
                                                   const PoseAdjustmentOptions& options) {
  const NodeStar::Fit fit = stars_[centre].fit(graph, poses_, options);
  cost_ += fit.cost - std::exchange(costs_[centre], fit.cost);
  return fit;
}

void IncrementalPoseAdjustment::give_pose(std::uint32_t node, PoseGraph& graph) const {
  const TPose2D pose(poses_[node].x, poses_[node].y, poses_[node].theta);
  if (pose != graph.pose(node)) graph.set_pose(node, pose);
}

IncrementalReport IncrementalPoseAdjustment::optimize(PoseGraph& graph, SparsePoseAdjustment& solver) {
  const auto nodes = static_cast<double>(graph.num_nodes());
  const auto solved = static_cast<double>(nodes_at_complete_solution_);
  if (nodes - solved > kGrowthBetweenCompleteSolutions * nodes || !continues(graph))
    return optimize_completely(graph, solver);
  IncrementalReport report;
  if (!add_news(graph) || !take_steps(graph, solver.options(), report))
    return optimize_completely(graph, solver);
  for (const CoreNode& core : core_) give_pose(core.node, graph);
  for (const std::uint32_t centre : std::exchange(placed_, {})) give_pose(centre, graph);
  report.core_nodes = core_.size();
  report.robust_chi2 = cost_;
  return report;
}

IncrementalReport IncrementalPoseAdjustment::optimize_completely(PoseGraph& graph,
                                                                 SparsePoseAdjustment& solver) {
  *this = IncrementalPoseAdjustment();
  const PoseAdjustmentReport solution = solver.optimize(graph);
  root_ = graph.root();
  nodes_at_complete_solution_ = graph.num_nodes();
  add_news(graph);
  for (const std::uint32_t centre : retired_) enter_fit(centre, graph, solver.options());
  IncrementalReport report;
  report.complete = true;
  report.iterations = solution.iterations;
  report.linearized_nodes = report.placed_nodes = graph.num_nodes();
  report.core_nodes = core_.size();
  report.robust_chi2 = solution.final_robust_chi2;
  const bool is_determined = linearize(graph, solver.options(), true);
  retired_.clear();
  if (!is_determined) *this = IncrementalPoseAdjustment();  // the next solution is complete, too
  return report;
}

}  // namespace psi_slam
