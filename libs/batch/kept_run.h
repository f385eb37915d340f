// SPDX-License-Identifier: BSD-3-Clause
// Results of runs in small JSON files. A run is not repeated while everything that its figures depend on
// stays the same.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace psi_slam {

struct RunKey {
  std::string text;   ///< checksum of all inputs of the run; the load of the machine is no input
  int processes = 1;  ///< number of runs that the machine makes at the same time
};

/// Contents of `file` if it has the text of `key` and was made with at most `key.processes` runs at a time.
/// Empty otherwise: times measured on a busier machine are not comparable.
std::optional<nlohmann::ordered_json> kept_run(const std::filesystem::path& file, const RunKey& key);

/// Writes the JSON object `content` and the key to `file`. Throws SystemFailure when the file cannot be
/// written.
void keep_run(const std::filesystem::path& file, const RunKey& key, const nlohmann::ordered_json& content);

/// Text of a JSON file: indented, with invalid UTF-8 replaced.
std::string json_file_text(const nlohmann::ordered_json& json);

/// Name of the log `file` without the ending of a log file: "intel" for "intel.clf.gz". Empty for a file
/// without such an ending.
std::optional<std::string> log_name_of(const std::string& file);

/// Processor and number of processors of this machine: "AMD EPYC, 2 processors".
std::string machine_text();

}  // namespace psi_slam
