// SPDX-License-Identifier: BSD-3-Clause
// Real scans and the local maps made from them. They come from a benchmark log if available, otherwise from
// MRPT's sample rawlog.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "mapping/local_maps/front_end.h"
#include "psi_slam/open_log.h"
#include "shared_logs.h"

namespace psi_slam {

struct RealScans {
  struct Node {
    mrpt::math::TPose2D local_T_robot;
    std::shared_ptr<const ScanPoints> points;
  };
  std::vector<Node> nodes;
  std::vector<PlacedLocalMap> maps;  ///< finished local maps
};

inline constexpr const char* kNeedsRealScans =
    "needs the benchmark logs (set PSI_SLAM_DATA) or the data sets of the package mrpt-common";

inline std::optional<std::filesystem::path> real_log() {
  if (const auto intel = shared_file("intel.clf.gz")) return intel;
  const std::filesystem::path rawlog =
      "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
  if (std::filesystem::exists(rawlog)) return rawlog;
  return std::nullopt;
}

inline RealScans read_real_scans(const std::filesystem::path& log, std::size_t max_frames = 1200) {
  FrontEndOptions options;
  options.nodes_per_local_map = 40;
  FrontEnd front_end(options);
  RealScans real;
  const auto source = open_log(log);
  for (std::size_t i = 0; i < max_frames; ++i) {
    const auto frame = source->next();
    if (!frame) break;
    const FrontEndStep step = front_end.add(*frame);
    if (step.node) real.nodes.push_back({step.local_T_robot, step.points});
    for (const PlacedLocalMap& finished : step.finished) real.maps.push_back(finished);
  }
  for (const PlacedLocalMap& finished : front_end.finish()) real.maps.push_back(finished);
  return real;
}

}  // namespace psi_slam
