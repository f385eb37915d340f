// SPDX-License-Identifier: BSD-3-Clause
// Pose graphs as text files: g2o's (VERTEX_SE2, EDGE_SE2, FIX) and, to read, TORO's (VERTEX2, EDGE2), plain
// or gzipped.
//
//   VERTEX_SE2 id x y theta
//   EDGE_SE2 from to dx dy dtheta  I_xx I_xy I_xt I_yy I_yt I_tt
//   FIX id
//   EDGE2 from to dx dy dtheta  I_xx I_xy I_yy I_tt I_xt I_yt
//
// The two formats differ not only in the order of the information's numbers but also in its axes: g2o weighs
// the error z^-1 (x_i^-1 x_j), whose axes are those of the measured *end* of the edge, TORO the error of
// equation 5, in the axes of its beginning. Both are turned into a Constraint's, so that chi2 is what g2o (or
// TORO) says of the same file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct PoseGraphFile {
  PoseGraph graph;
  std::vector<std::int64_t>
      ids;  ///< the file's vertex id of each node, ascending: ids 0 .. N-1 are the node numbers
};

/// Edges between successive nodes become odometry, the others loops. The vertex of a FIX line becomes the
/// root, else the first node is. A file with edges only gets its poses by spanning_tree_poses(). Throws
/// UserError naming file and line when a line is not understood, incomplete or inconsistent with another (a
/// vertex that comes twice or is missing, a second fixed vertex), or when the file cannot be read.
PoseGraphFile read_pose_graph(const std::filesystem::path& path);

/// All nodes, FIX of the root, and the enabled constraints; every number in the fewest digits that read back
/// as the same double. The file appears whole or not at all. Throws SystemFailure when it cannot be written.
void write_g2o(const PoseGraph& graph, const std::filesystem::path& path);

}  // namespace psi_slam
