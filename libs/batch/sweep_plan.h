// SPDX-License-Identifier: BSD-3-Clause
// Plan of a sweep: every log with every combination of settings and every seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/seeds.h"

namespace psi_slam {

/// Arguments of `psi-slam sweep`.
struct SweepRequest {
  std::vector<std::string> logs;  ///< "LOG", or "LOG@INI" with the log's own settings
  /// Folder with the settings NAME.ini of logs without "@INI"; empty: the folder of each log.
  std::string ini_folder;
  /// File with the relations of the only log; empty: NAME.relations beside each log, if it exists.
  std::string relations;
  std::vector<std::string> configs;  ///< settings files to compare; empty: the logs' own settings
  std::vector<std::string> choices;  ///< options to vary: "section.key=value,value,..."
  SeedRange seeds;
  int threads = 1;  ///< threads of each run
};

struct SweepLog {
  std::string name;           ///< "intel"; the whole path if two logs have the same name
  std::filesystem::path log;  ///< a file, or the folder of one recording
  std::filesystem::path ini;  ///< file with the log's own settings; empty: none
  std::optional<std::filesystem::path> relations;
  std::string sha256;
  std::uintmax_t bytes = 0;      ///< size of the log
  std::string relations_sha256;  ///< checksum of the relations; empty: no relations
};

struct SweepRun {
  std::size_t log = 0;              ///< index in SweepPlan::logs
  std::vector<std::string> values;  ///< the value of each of SweepPlan::columns
  std::uint64_t seed = 1;
  std::string settings;  ///< contents of a settings file with all options
  std::string key;       ///< checksum of everything that the result depends on
  std::string folder;    ///< name of the run's folder: "intel-seed3-0123456789abcdef"
};

struct SweepPlan {
  std::vector<SweepLog> logs;
  /// Names of the options that vary, besides log and seed: "config", "map.resolution_m".
  std::vector<std::string> columns;
  std::vector<SweepRun> runs;         ///< sorted by log, then setting, then seed
  std::vector<std::string> warnings;  ///< warnings about renamed settings, each only once
};

/// Combines the defaults, the log's own settings, the settings file, the choices and the seed; each of them
/// overrides those before it. `program_sha256` is the checksum of the program that makes the runs. Throws
/// UserError for a file that cannot be read, for an invalid setting, and when two runs would be equal.
SweepPlan plan_sweep(const SweepRequest& request, const std::string& program_sha256);

}  // namespace psi_slam
