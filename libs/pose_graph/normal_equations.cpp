// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/normal_equations.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "pose_graph/spanning_tree.h"

namespace psi_slam {
namespace {

// An order of elimination is replaced when the nodes added at its end exceed this share of all nodes.
constexpr double kMaxAppendedShare = 0.2;
// An order of elimination is also replaced when its wasted block products cost as much as computing a new
// order. That takes the time of this many block products per constraint.
constexpr double kProductsOfOrderingPerLink = 15;

std::uint32_t find_set(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Returns the number of block products of one factorisation beyond those of an order that is as good as the
// order computed last.
double wasted_products(std::size_t products, std::size_t variables, double ordered_products,
                       std::size_t ordered_variables) {
  const double growth =
      static_cast<double>(variables) / std::max(1.0, static_cast<double>(ordered_variables));
  return std::max(0.0, static_cast<double>(products) - growth * ordered_products);
}

Eigen::Index row(std::uint32_t variable) {
  return 3 * static_cast<Eigen::Index>(variable);
}

}  // namespace

bool NormalEquations::continues(const PoseGraph& graph) const {
  if (graph.num_nodes() < variable_of_.size() || graph.num_constraints() < ends_.size()) return false;
  if (variable_of_.empty() || graph.root() != root_) return false;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const GraphLink& link = graph.links()[i];
    if (link.from != ends_[i].first || link.to != ends_[i].second) return false;
  }
  return true;
}

void NormalEquations::check_connected(const PoseGraph& graph) {
  component_.resize(graph.num_nodes());
  std::iota(component_.begin(), component_.end(), 0U);
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const std::uint32_t a = find_set(component_, ends_[i].first);
    const std::uint32_t b = find_set(component_, ends_[i].second);
    component_[std::max(a, b)] = std::min(a, b);
  }
  const std::uint32_t of_root = find_set(component_, static_cast<std::uint32_t>(graph.root()));
  for (std::uint32_t node = 0; node < graph.num_nodes(); ++node)
    if (find_set(component_, node) != of_root) throw unreachable_node(node, graph.root());
}

void NormalEquations::prepare(const PoseGraph& graph) {
  reordered_ = restructured_ = false;
  if (!continues(graph)) {
    node_of_.clear();
    variable_of_.clear();
    ends_.clear();
    places_.clear();
    root_ = graph.root();
    ordered_variables_ = 0;
  }
  bool must_lay_out = ordered_variables_ == 0;
  for (std::size_t node = variable_of_.size(); node < graph.num_nodes(); ++node) {
    must_lay_out = true;
    if (node == root_) {
      variable_of_.push_back(kHeld);
    } else {
      variable_of_.push_back(static_cast<std::uint32_t>(node_of_.size()));
      node_of_.push_back(static_cast<std::uint32_t>(node));
    }
  }
  for (std::size_t i = ends_.size(); i < graph.num_constraints(); ++i) {
    const GraphLink& link = graph.links()[i];
    ends_.emplace_back(link.from, link.to);
  }
  places_.resize(ends_.size());
  for (std::size_t i = 0; i < places_.size() && !must_lay_out; ++i)
    must_lay_out = graph.enabled(i) && !places_[i].known;
  check_connected(graph);
  if (!must_lay_out) return;

  restructured_ = true;
  const auto variables = static_cast<double>(node_of_.size());
  const double worth_an_order = kProductsOfOrderingPerLink * static_cast<double>(ends_.size());
  bool must_order = variables * (1 - kMaxAppendedShare) > static_cast<double>(ordered_variables_) ||
                    wasted_products_ > worth_an_order;
  if (must_order) find_order(graph);
  lay_out(graph);
  if (!must_order && wasted_products(factor_.num_products(), node_of_.size(), ordered_products_,
                                     ordered_variables_) > worth_an_order) {
    must_order = true;
    find_order(graph);
    lay_out(graph);
  }
  if (must_order) {
    ordered_variables_ = node_of_.size();
    ordered_products_ = static_cast<double>(factor_.num_products());
    wasted_products_ = 0;
    reordered_ = true;
  }
}

void NormalEquations::find_order(const PoseGraph& graph) {
  // Starts from the order of insertion, so that the result does not depend on earlier orders.
  node_of_.clear();
  for (std::uint32_t node = 0; node < graph.num_nodes(); ++node) {
    variable_of_[node] = node == root_ ? kHeld : static_cast<std::uint32_t>(node_of_.size());
    if (node != root_) node_of_.push_back(node);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    const std::uint32_t a = variable_of_[ends_[i].first];
    const std::uint32_t b = variable_of_[ends_[i].second];
    if (graph.enabled(i) && a != kHeld && b != kHeld) links.emplace_back(a, b);
  }
  const std::vector<std::uint32_t> order = fill_reducing_order(node_of_.size(), links);
  const std::vector<std::uint32_t> nodes = node_of_;
  for (std::size_t k = 0; k < order.size(); ++k) {
    node_of_[k] = nodes[order[k]];
    variable_of_[node_of_[k]] = static_cast<std::uint32_t>(k);
  }
}

void NormalEquations::lay_out(const PoseGraph& graph) {
  const std::size_t n = node_of_.size();
  // Column, row and constraint of each block off the diagonal.
  std::vector<std::array<std::uint32_t, 3>> links;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    places_[i] = Place();
    if (!graph.enabled(i)) continue;
    const std::uint32_t a = variable_of_[ends_[i].first];
    const std::uint32_t b = variable_of_[ends_[i].second];
    places_[i] = {kNoBlock, true, a > b};
    if (a != kHeld && b != kHeld)
      links.push_back({std::max(a, b), std::min(a, b), static_cast<std::uint32_t>(i)});
  }
  std::sort(links.begin(), links.end());

  hessian_.rows.clear();
  hessian_.column_begin.assign(n + 1, 0);
  auto link = links.begin();
  for (std::size_t k = 0; k < n; ++k) {
    for (; link != links.end() && (*link)[0] == k; ++link) {
      const auto [column, row, constraint] = *link;
      if (hessian_.rows.size() == hessian_.column_begin[k] || hessian_.rows.back() != row)
        hessian_.rows.push_back(row);
      places_[constraint].block = static_cast<std::uint32_t>(hessian_.rows.size() - 1);
    }
    hessian_.column_begin[k + 1] = hessian_.rows.size();
  }
  hessian_.blocks.resize(hessian_.rows.size());
  hessian_.diagonal.resize(n);
  gradient_.resize(3 * static_cast<Eigen::Index>(n));
  factor_.analyze(hessian_);
}

void NormalEquations::linearize(const PoseGraph& graph, const std::vector<RotatedPose>& poses,
                                const std::vector<Eigen::Vector3d>& errors,
                                const std::vector<double>& weights, Coordinates coordinates) {
  std::fill(hessian_.blocks.begin(), hessian_.blocks.end(), Eigen::Matrix3d::Zero());
  std::fill(hessian_.diagonal.begin(), hessian_.diagonal.end(), Eigen::Matrix3d::Zero());
  gradient_.setZero();
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    if (!graph.enabled(i)) continue;
    const auto [from, to] = ends_[i];
    Eigen::Matrix3d information = weights[i] * graph.constraints()[i].information;
    if (coordinates == Coordinates::kHeadings)
      information = Eigen::Vector3d(0, 0, information(2, 2)).asDiagonal();
    const ConstraintNormals normals = constraint_normals(information, errors[i], poses[from], poses[to]);
    const std::uint32_t a = variable_of_[from];
    const std::uint32_t b = variable_of_[to];
    if (a != kHeld) {
      hessian_.diagonal[a] += normals.ii;
      gradient_.segment<3>(row(a)) += normals.i;
    }
    if (b != kHeld) {
      hessian_.diagonal[b] += normals.jj;
      gradient_.segment<3>(row(b)) += normals.j;
    }
    if (places_[i].block == kNoBlock) continue;
    if (places_[i].transposed) {
      hessian_.blocks[places_[i].block] += normals.ij.transpose();
    } else {
      hessian_.blocks[places_[i].block] += normals.ij;
    }
  }
  if (coordinates == Coordinates::kHeadings) {
    hold(0);
    hold(1);
  } else if (coordinates == Coordinates::kPositions) {
    hold(2);
  }
}

// Holds one coordinate of all nodes (0: x, 1: y, 2: heading): its step becomes 0.
void NormalEquations::hold(int coordinate) {
  for (Eigen::Matrix3d& block : hessian_.blocks) {
    block.row(coordinate).setZero();
    block.col(coordinate).setZero();
  }
  for (std::size_t k = 0; k < hessian_.diagonal.size(); ++k) {
    hessian_.diagonal[k].row(coordinate).setZero();
    hessian_.diagonal[k].col(coordinate).setZero();
    hessian_.diagonal[k](coordinate, coordinate) = 1;
    gradient_[row(static_cast<std::uint32_t>(k)) + coordinate] = 0;
  }
}

bool NormalEquations::factorize(double lambda) {
  wasted_products_ +=
      wasted_products(factor_.num_products(), node_of_.size(), ordered_products_, ordered_variables_);
  return factor_.factorize(hessian_, lambda);
}

Eigen::VectorXd NormalEquations::step() const {
  Eigen::VectorXd x = -gradient_;
  factor_.solve(x);
  return x;
}

double NormalEquations::predicted_decrease(const Eigen::VectorXd& step, double lambda) const {
  // dx^T H dx = -g^T dx - lambda dx^T diag(H) dx
  double damping = 0;
  for (std::size_t k = 0; k < hessian_.diagonal.size(); ++k) {
    const auto dx = step.segment<3>(row(static_cast<std::uint32_t>(k)));
    damping += dx.cwiseAbs2().dot(hessian_.diagonal[k].diagonal());
  }
  return -gradient_.dot(step) + lambda * damping;
}

}  // namespace psi_slam
