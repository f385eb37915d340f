// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/pose_graph/path_covariance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <queue>
#include <stdexcept>
#include <utility>

namespace psi_slam {
namespace {

// A symmetric 3x3 covariance of (x, y, theta), x and y in the axes of the map.
struct Covariance {
  double xx = 0, xy = 0, xt = 0, yy = 0, yt = 0, tt = 0;
};

struct Node {
  double x = 0, y = 0, cosine = 1, sine = 0;
  double cost = std::numeric_limits<double>::infinity();
  std::uint32_t constraint = 0;
  std::uint32_t previous = 0;
  bool settled = false;
};

// Positions are turned by the angle, headings stay.
Covariance turned(const Covariance& a, double cosine, double sine) {
  const double off = sine * cosine * (a.xx - a.yy);
  const double cc = cosine * cosine;
  const double ss = sine * sine;
  const double both = 2 * sine * cosine * a.xy;
  return {cc * a.xx - both + ss * a.yy, off + (cc - ss) * a.xy,      cosine * a.xt - sine * a.yt,
          ss * a.xx + both + cc * a.yy, sine * a.xt + cosine * a.yt, a.tt};
}

// Of a point that is carried at (dx, dy) from the pose with this covariance.
Covariance carried(const Covariance& a, double dx, double dy) {
  const double xt = a.xt - dy * a.tt;
  const double yt = a.yt + dx * a.tt;
  return {a.xx - dy * (a.xt + xt), a.xy + dx * a.xt - dy * yt, xt, a.yy + dx * (a.yt + yt), yt, a.tt};
}

void add(Covariance& a, const Covariance& b) {
  a.xx += b.xx;
  a.xy += b.xy;
  a.xt += b.xt;
  a.yy += b.yy;
  a.yt += b.yt;
  a.tt += b.tt;
}

// One step of a chain. Forwards, the new node's error is the old one's carried to it plus the measurement's;
// backwards the measurement's heading error turns the step as the old one's does: both are carried.
Covariance extended(const Covariance& at_previous, const GraphLink& link, const Node& previous,
                    const Node& next, bool forwards) {
  const Node& from = forwards ? previous : next;
  const Covariance measured =
      turned({link.xx, link.xy, link.xt, link.yy, link.yt, link.tt}, from.cosine, from.sine);
  const double dx = next.x - previous.x;
  const double dy = next.y - previous.y;
  Covariance result = at_previous;
  if (!forwards) add(result, measured);
  result = carried(result, dx, dy);
  if (forwards) add(result, measured);
  return result;
}

// The cost of extended() without the work: a trace needs no rotation of the measurement's position part.
double extended_cost(const Covariance& at_previous, const GraphLink& link, const Node& previous,
                     const Node& next, bool forwards, double lever2) {
  double xt = at_previous.xt;
  double yt = at_previous.yt;
  double tt = at_previous.tt;
  if (!forwards) {
    xt += next.cosine * link.xt - next.sine * link.yt;
    yt += next.sine * link.xt + next.cosine * link.yt;
    tt += link.tt;
  }
  const double dx = next.x - previous.x;
  const double dy = next.y - previous.y;
  return at_previous.xx + at_previous.yy + link.xx + link.yy + 2 * (dx * yt - dy * xt) +
         (dx * dx + dy * dy) * tt + lever2 * (at_previous.tt + link.tt);
}

}  // namespace

double RelativeUncertainty::position_sigma_m() const {
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(std::max(0.0, mean + std::hypot(difference, covariance(0, 1))));
}

std::vector<RelativeUncertainty> path_covariances(const PoseGraph& graph, std::size_t source,
                                                  const PathCovarianceOptions& options) {
  if (source >= graph.num_nodes())
    throw std::out_of_range("path_covariances: the source is no node of the graph");
  std::vector<Node> nodes(graph.num_nodes());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const mrpt::math::TPose2D& pose = graph.poses()[i];
    nodes[i].x = pose.x;
    nodes[i].y = pose.y;
    nodes[i].cosine = std::cos(pose.phi);
    nodes[i].sine = std::sin(pose.phi);
  }
  std::vector<Covariance> covariances(nodes.size());
  std::vector<RelativeUncertainty> result(nodes.size());
  std::vector<char> wanted(nodes.size(), 0);
  std::size_t num_wanted = 0;
  for (const std::size_t target : options.targets) {
    num_wanted += wanted.at(target) == 0 ? 1 : 0;
    wanted[target] = 1;
  }
  const double lever2 = options.heading_lever_m * options.heading_lever_m;
  const double max_cost = options.max_sigma_m * options.max_sigma_m;

  using Entry = std::pair<double, std::uint32_t>;  // cost, node
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  nodes[source].cost = 0;
  nodes[source].previous = static_cast<std::uint32_t>(source);
  queue.emplace(0.0, static_cast<std::uint32_t>(source));
  while (!queue.empty()) {
    const std::uint32_t here = queue.top().second;
    queue.pop();
    Node& node = nodes[here];
    if (node.settled) continue;
    node.settled = true;
    if (here != source) {
      const GraphLink& link = graph.links()[node.constraint];
      covariances[here] =
          extended(covariances[node.previous], link, nodes[node.previous], node, link.to == here);
    }
    const Covariance& covariance = covariances[here];
    const Covariance own = turned(covariance, nodes[source].cosine, -nodes[source].sine);
    RelativeUncertainty& uncertainty = result[here];
    uncertainty.reached = true;
    uncertainty.previous = node.previous;
    uncertainty.constraint = node.constraint;
    uncertainty.covariance << own.xx, own.xy, own.xt, own.xy, own.yy, own.yt, own.xt, own.yt, own.tt;
    if (wanted[here] != 0 && --num_wanted == 0) break;

    for (const std::uint32_t index : graph.constraints_of(here)) {
      const GraphLink& link = graph.links()[index];
      const bool forwards = link.from == here;
      const std::uint32_t there = forwards ? link.to : link.from;
      Node& next = nodes[there];
      if (next.settled || !graph.enabled(index)) continue;
      const double cost = extended_cost(covariance, link, node, next, forwards, lever2);
      if (!(cost < next.cost) || cost > max_cost) continue;
      next.cost = cost;
      next.constraint = index;
      next.previous = here;
      queue.emplace(cost, there);
    }
  }
  return result;
}

}  // namespace psi_slam
