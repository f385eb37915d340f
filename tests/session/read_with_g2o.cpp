// SPDX-License-Identifier: BSD-3-Clause
// Prints a pose graph as g2o's own library reads it, in the lines of foreign_readers.py.
#include <g2o/core/optimizable_graph.h>
#include <g2o/types/slam2d/edge_se2.h>
#include <g2o/types/slam2d/vertex_se2.h>

#include <cstdio>

int main(int count, char** arguments) {
  g2o::OptimizableGraph graph;
  if (count != 2 || !graph.load(arguments[1])) return 1;
  for (const auto& [id, any] : graph.vertices()) {
    const auto* vertex = dynamic_cast<const g2o::VertexSE2*>(any);
    if (vertex == nullptr) return 1;
    const Eigen::Vector3d pose = vertex->estimate().toVector();
    std::printf("pose %d %.17g %.17g %.17g\n", id, pose[0], pose[1], pose[2]);
    if (vertex->fixed()) std::printf("fixed %d\n", id);
  }
  double chi2 = 0;
  for (auto* any : graph.edges()) {
    auto* edge = dynamic_cast<g2o::EdgeSE2*>(any);
    if (edge == nullptr) return 1;
    edge->computeError();
    chi2 += edge->chi2();
    const Eigen::Vector3d z = edge->measurement().toVector();
    const auto& i = edge->information();
    std::printf("edge %d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", edge->vertex(0)->id(),
                edge->vertex(1)->id(), z[0], z[1], z[2], i(0, 0), i(0, 1), i(0, 2), i(1, 1), i(1, 2),
                i(2, 2));
  }
  std::printf("chi2 %.17g\n", chi2);
  return 0;
}
