// SPDX-License-Identifier: BSD-3-Clause
// The section [GeneralConfiguration] of MRPT's graphslam-engine.
#pragma once

#include <filesystem>
#include <string>

namespace psi_slam {

struct GraphSlamGeneral {
  std::string output_dir_fname = "graphslam_results";
  bool save_graph = true;
  std::string save_graph_fname = "output_graph.graph";
  bool save_map = true;
  std::string save_map_fname = "output_map";
  bool save_3DScene = true;
  std::string save_3DScene_fname = "scene.3DScene";
};

/// Keys that only MRPT's engine and deciders read are left to them. Throws UserError, with file and line, for
/// a key that neither knows and for a value that is not accepted.
GraphSlamGeneral read_graphslam_general(const std::filesystem::path& ini);

}  // namespace psi_slam
