// SPDX-License-Identifier: BSD-3-Clause
// Finds the logs of the benchmarks and their settings, and maps logs in the same way as psi-slam.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "map/trajectory/relations_metric.h"
#include "mapping/mapper_options.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"
#include "session/settings.h"

namespace psi_slam {

struct BenchmarkLog {
  std::string name;                                ///< "intel"
  std::filesystem::path log;                       ///< intel.clf.gz
  std::filesystem::path ini;                       ///< intel.ini, with the parameters of the sensor
  std::optional<std::filesystem::path> relations;  ///< intel.relations, if it exists
};

/// Logs in the folder `data`, ordered by name. A log is NAME.clf, NAME.log or NAME.rawlog, gzipped or not, or
/// a ROS bag. Of several files with one NAME, takes the first in alphabetical order. BenchmarkLog::ini is
/// empty if `ini` has no NAME.ini. Throws UserError when `data` is not a folder.
std::vector<BenchmarkLog> logs_in_folder(const std::filesystem::path& data, const std::filesystem::path& ini);

/// Calls logs_in_folder(). Throws UserError if there is no log.
std::vector<BenchmarkLog> find_benchmark_logs(const std::filesystem::path& data,
                                              const std::filesystem::path& ini);

/// Folder of the settings that come with the program, installed or in the source tree. Searches upwards from
/// the folder of the program. Empty if there is none.
std::optional<std::filesystem::path> shipped_ini_folder();

/// Settings of a log: the defaults, overridden by the file `ini` unless it is empty, and by assignments
/// "section.key=value". Appends a sentence to `warnings` for each renamed option in the file. Throws
/// UserError for settings that psi-slam refuses.
Settings benchmark_settings(const std::filesystem::path& ini,
                            const std::vector<std::string>& assignments = {},
                            std::vector<std::string>* warnings = nullptr);

/// Settings "section.key=value" that choose the matcher by Psi as in the paper: exact search up to psi_1, the
/// genetic search from psi_2 on, both combined between them, in windows of any size. The paper gives no
/// values of psi_1 and psi_2; these values are ours.
std::vector<std::string> paper_switch_settings();

/// Maps all frames. Calls `progress` with the share of the log that is read, in [0, 1]. Passes on exceptions
/// of the source.
MappingResult map_source(FrameSource& source, const MapperOptions& options,
                         const std::function<void(double)>& progress);

/// A file that the destructor deletes.
struct ScratchFile {
  std::filesystem::path path;

  explicit ScratchFile(std::filesystem::path file) : path(std::move(file)) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// Number of accepted loops.
std::size_t loops_accepted(const MappingResult& result);

/// Errors of the frames' final poses over the relations. Throws UserError as evaluate_relations().
RelationsMetric error_of(const std::vector<FrameRecord>& frames, const std::vector<Relation>& relations);

}  // namespace psi_slam
