// SPDX-License-Identifier: BSD-3-Clause
// Reads pose graphs in g2o format (VERTEX_SE2, EDGE_SE2, FIX) and TORO format (VERTEX2, EDGE2), plain or
// compressed, and writes them in g2o format.
//
//   VERTEX_SE2 id x y theta
//   EDGE_SE2 from to dx dy dtheta  I_xx I_xy I_xt I_yy I_yt I_tt
//   FIX id
//   EDGE2 from to dx dy dtheta  I_xx I_xy I_yy I_tt I_xt I_yt
//
// The formats differ in the order of the entries of the information matrix and in its axes. g2o weights the
// error z^-1 (x_i^-1 x_j), in the axes of the edge's end. TORO weights the error of equation 5, in the axes
// of the edge's beginning. Both are converted to a Constraint, so that chi2 equals that of g2o or TORO.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct PoseGraphFile {
  PoseGraph graph;
  std::vector<std::int64_t> ids;  ///< vertex id in the file for each node, ascending
};

/// Reads a pose graph. Edges between successive nodes become odometry, other edges loops. The root is the
/// vertex of the FIX line, or the first node if there is no FIX line. If the file has edges but no vertices,
/// spanning_tree_poses() computes the poses. Throws UserError with file and line for a line that is malformed
/// or inconsistent with another line (a repeated or missing vertex, a second fixed vertex). Throws UserError
/// with the file if it is not readable.
PoseGraphFile read_pose_graph(const std::filesystem::path& path);

/// Writes all nodes, FIX for the root, and the enabled constraints. Numbers have the fewest digits that read
/// back as the same number. A constraint that knows no heading gets the information 1e-6 per rad^2 for it,
/// because GTSAM refuses singular matrices. The file appears complete or not at all. Throws SystemFailure if
/// it cannot be written.
void write_g2o(const PoseGraph& graph, const std::filesystem::path& path);

}  // namespace psi_slam
