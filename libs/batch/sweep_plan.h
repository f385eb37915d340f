// SPDX-License-Identifier: BSD-3-Clause
// A sweep before it is run: every log with every combination of settings and every seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/seed_range.h"

namespace psi_slam {

/// What the user asks for.
struct SweepRequest {
  std::vector<std::string> logs;     ///< "LOG", or "LOG@INI" with the log's own settings
  std::string ini_folder;            ///< where other logs have theirs, as NAME.ini; empty: beside the log
  std::string relations;             ///< of the one log; empty: NAME.relations beside each, where it is there
  std::vector<std::string> configs;  ///< settings files to choose from; none: only what the logs have
  std::vector<std::string> choices;  ///< "section.key=value,value,..."
  SeedRange seeds;
  int threads = 1;  ///< of each run
};

struct SweepLog {
  std::string name;                                ///< "intel"; the whole path where two files have one name
  std::filesystem::path log;                       ///< a file, or a folder of one recording
  std::filesystem::path ini;                       ///< its own settings; empty: none
  std::optional<std::filesystem::path> relations;  ///< that are known to be true
  std::string sha256;
  std::uintmax_t bytes = 0;      ///< of the log
  std::string relations_sha256;  ///< empty: none
};

struct SweepRun {
  std::size_t log = 0;              ///< in the plan
  std::vector<std::string> values;  ///< of the plan's columns
  std::uint64_t seed = 1;
  std::string settings;  ///< a settings file with all options
  std::string key;       ///< checksum of all that the result depends on
  std::string folder;    ///< its name among the runs: "intel-seed3-0123456789abcdef"
};

struct SweepPlan {
  std::vector<SweepLog> logs;
  std::vector<std::string> columns;   ///< what varies besides log and seed: "config", "map.resolution_m"
  std::vector<SweepRun> runs;         ///< by log, then by setting, then by seed
  std::vector<std::string> warnings;  ///< about renamed settings, each once
};

/// Lays one over the other: the defaults, the log's own settings, the settings file, the choices, the seed.
/// `program_sha256` is of the program that will do the runs. Throws UserError when a file cannot be read, a
/// setting is refused, or two runs would be the same.
SweepPlan plan_sweep(const SweepRequest& request, const std::string& program_sha256);

}  // namespace psi_slam
