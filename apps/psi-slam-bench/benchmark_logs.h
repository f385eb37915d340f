// SPDX-License-Identifier: BSD-3-Clause
// The benchmark's logs, and what mapping one of them leaves for a matcher to be tried on.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loop_closure/keyframe_store.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "session/settings.h"

namespace psi_slam {

struct BenchmarkLog {
  std::string name;                                ///< "intel"
  std::filesystem::path log;                       ///< intel.clf.gz
  std::filesystem::path ini;                       ///< intel.ini: the facts of the sensor
  std::optional<std::filesystem::path> relations;  ///< intel.relations, where it is there
};

/// The logs of a folder by name: NAME.clf, .log or .rawlog, gzipped or not. Throws UserError when `data` is
/// no folder or holds no log, and when a log has no NAME.ini in `ini`.
std::vector<BenchmarkLog> find_benchmark_logs(const std::filesystem::path& data,
                                              const std::filesystem::path& ini);

/// The folder of the settings that come with the program, installed or in the tree it was built from: looked
/// for from the program's own folder upwards.
std::optional<std::filesystem::path> shipped_ini_folder();

/// The settings of a log: the defaults, what its file says, and "section.key=value" on top. Throws UserError
/// for what psi-slam would refuse.
Settings benchmark_settings(const std::filesystem::path& ini,
                            const std::vector<std::string>& assignments = {});

/// A mapped log: what a loop closer would have, and where everything truly was.
struct MappedLog {
  std::string name;
  MapperOptions options;
  KeyframeStore memory;                           ///< of the whole log
  std::vector<mrpt::math::TPose2D> map_T_node;  ///< optimised
  std::vector<std::string> adaptive_matcher;    ///< by node: what the adaptive matcher uses there
  double translation_error_m = 0;               ///< mean over the true relations
};

/// How `adaptive_matcher` is chosen, as the tables say it: cases drawn one by one have no history of their
/// own.
inline constexpr const char* kAdaptiveNote =
    "the matcher that Psi chose at the scan's node when the log was mapped";

/// Maps a log whose relations are there. Local maps hold so many nodes, or as long a path in proportion to
/// the settings' own. `progress` is called with the share done. Throws UserError as open_log() and
/// read_relations() do.
MappedLog map_log(const BenchmarkLog& log, std::size_t nodes_per_local_map,
                  const std::function<void(double)>& progress);

}  // namespace psi_slam
