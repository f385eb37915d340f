// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/path_covariance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "logs/frames/position_variance.h"

namespace psi_slam {
namespace {

// Returns R a R^T, where R is the rotation by the angle with this cosine and sine.
PoseCovariance turned_covariance(const PoseCovariance& a, double cosine, double sine) {
  const double off = sine * cosine * (a.xx - a.yy);
  const double cc = cosine * cosine;
  const double ss = sine * sine;
  const double both = 2 * sine * cosine * a.xy;
  return {cc * a.xx - both + ss * a.yy, off + (cc - ss) * a.xy,      cosine * a.xt - sine * a.yt,
          ss * a.xx + both + cc * a.yy, sine * a.xt + cosine * a.yt, a.tt};
}

// Returns the covariance of a pose that is rigidly attached at (dx, dy) to the pose with covariance `a`.
PoseCovariance carried(const PoseCovariance& a, double dx, double dy) {
  const double xt = a.xt - dy * a.tt;
  const double yt = a.yt + dx * a.tt;
  return {a.xx - dy * (a.xt + xt), a.xy + dx * a.xt - dy * yt, xt, a.yy + dx * (a.yt + yt), yt, a.tt};
}

void add(PoseCovariance& a, const PoseCovariance& b) {
  a.xx += b.xx;
  a.xy += b.xy;
  a.xt += b.xt;
  a.yy += b.yy;
  a.yt += b.yt;
  a.tt += b.tt;
}

// Extends a chain by one link. Forwards, the error of the next node is the error of the previous node,
// carried to the next node, plus the error of the measurement. Backwards, the heading error of the
// measurement also turns the step, so both errors are carried.
PoseCovariance extended(const PoseCovariance& at_previous, const PoseCovariance& of_link,
                        const RotatedPose& previous, const RotatedPose& next, bool forwards) {
  const RotatedPose& from = forwards ? previous : next;
  const PoseCovariance measured = turned_covariance(of_link, from.cosine, from.sine);
  const double dx = next.x - previous.x;
  const double dy = next.y - previous.y;
  PoseCovariance result = at_previous;
  if (!forwards) add(result, measured);
  result = carried(result, dx, dy);
  if (forwards) add(result, measured);
  return result;
}

// Returns the cost of extended(), with less work: a trace needs no rotation of the position part of the
// measurement.
double extended_cost(const PoseCovariance& at_previous, const PoseCovariance& measured,
                     const RotatedPose& previous, const RotatedPose& next, bool forwards, double lever2) {
  double xt = at_previous.xt;
  double yt = at_previous.yt;
  double tt = at_previous.tt;
  if (!forwards) {
    xt += next.cosine * measured.xt - next.sine * measured.yt;
    yt += next.sine * measured.xt + next.cosine * measured.yt;
    tt += measured.tt;
  }
  const double dx = next.x - previous.x;
  const double dy = next.y - previous.y;
  return at_previous.xx + at_previous.yy + measured.xx + measured.yy + 2 * (dx * yt - dy * xt) +
         (dx * dx + dy * dy) * tt + lever2 * (at_previous.tt + measured.tt);
}

}  // namespace

double RelativeUncertainty::position_sigma_m() const {
  return std::sqrt(std::max(0.0, largest_position_variance_m2(covariance)));
}

PathCovarianceSearch::Node& PathCovarianceSearch::node_at(const PoseGraph& graph, std::size_t index) {
  Node& node = nodes_.at(index);
  if (node.run == run_) return node;
  ++seen_;
  // Begins to fetch the list of constraints, which lies anywhere in memory, before look_around() needs it.
  __builtin_prefetch(graph.constraints_of(index).data());
  node = Node();
  node.run = run_;
  const mrpt::math::TPose2D& pose = graph.poses()[index];
  node.pose.x = pose.x;
  node.pose.y = pose.y;
  node.pose.theta = pose.phi;
  return node;
}

// Computes sine and cosine of the heading, which only nodes need where a constraint of a chain begins.
void PathCovarianceSearch::rotate(Node& node) {
  if (node.rotated) return;
  node.rotated = true;
  node.pose = RotatedPose({node.pose.x, node.pose.y, node.pose.theta});
}

PoseCovariance PathCovarianceSearch::measured_by(const GraphLink& link) const {
  PoseCovariance covariance = link.covariance;
  if (with_doubt_) add(covariance, link.doubt);
  return covariance;
}

void PathCovarianceSearch::settle(const PoseGraph& graph, std::uint32_t here) {
  Node& node = nodes_[here];
  node.settled = true;
  if (here == source_) return;
  Node& previous = nodes_[node.previous];
  const GraphLink& link = graph.links()[node.constraint];
  rotate(link.to == here ? previous : node);
  node.covariance =
      extended(previous.covariance, measured_by(link), previous.pose, node.pose, link.to == here);
}

void PathCovarianceSearch::look_around(const PoseGraph& graph, std::uint32_t here, double lever2,
                                       double max_cost) {
  const Node& node = nodes_[here];
  for (const std::uint32_t index : graph.constraints_of(here)) {
    const GraphLink& link = graph.links()[index];
    const bool forwards = link.from == here;
    const std::uint32_t there = forwards ? link.to : link.from;
    Node& next = node_at(graph, there);
    if (next.settled || !graph.enabled(index)) continue;
    // No chain leads through a node with a single constraint.
    if (only_targets_ && !next.wanted && graph.constraints_of(there).size() == 1) continue;
    if (!forwards) rotate(next);
    const double cost =
        extended_cost(node.covariance, measured_by(link), node.pose, next.pose, forwards, lever2);
    if (!(cost < next.cost) || cost > max_cost) continue;
    next.cost = cost;
    next.constraint = index;
    next.previous = here;
    queue_.emplace(cost, there);
  }
}

void PathCovarianceSearch::run(const PoseGraph& graph, std::size_t source,
                               const PathCovarianceOptions& options) {
  if (source >= graph.num_nodes())
    throw std::out_of_range("PathCovarianceSearch: the source is not a node of the graph");
  ++run_;
  seen_ = 0;
  source_ = source;
  with_doubt_ = options.with_doubt;
  only_targets_ = !options.targets.empty();
  nodes_.resize(graph.num_nodes());
  queue_ = {};
  std::size_t num_wanted = 0;
  for (const std::size_t target : options.targets) {
    Node& node = node_at(graph, target);
    num_wanted += node.wanted ? 0 : 1;
    node.wanted = true;
  }
  const double lever2 = options.heading_lever_m * options.heading_lever_m;
  const double max_cost = options.max_sigma_m * options.max_sigma_m;

  Node& first = node_at(graph, source);
  rotate(first);
  first.cost = 0;
  first.previous = static_cast<std::uint32_t>(source);
  queue_.emplace(0.0, static_cast<std::uint32_t>(source));
  while (!queue_.empty()) {
    const std::uint32_t here = queue_.top().second;
    queue_.pop();
    if (nodes_[here].settled) continue;
    settle(graph, here);
    if (nodes_[here].wanted && --num_wanted == 0) break;
    look_around(graph, here, lever2, max_cost);
  }
}

RelativeUncertainty PathCovarianceSearch::of(std::size_t index) const {
  RelativeUncertainty uncertainty;
  const Node& node = nodes_.at(index);
  if (node.run != run_ || !node.settled) return uncertainty;
  const RotatedPose& source = nodes_[source_].pose;
  const PoseCovariance own = turned_covariance(node.covariance, source.cosine, -source.sine);
  uncertainty.reached = true;
  uncertainty.previous = node.previous;
  uncertainty.constraint = node.constraint;
  uncertainty.covariance << own.xx, own.xy, own.xt, own.xy, own.yy, own.yt, own.xt, own.yt, own.tt;
  return uncertainty;
}

}  // namespace psi_slam
