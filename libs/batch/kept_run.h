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
  std::string text;   ///< checksum of all inputs of the run, except how busy the machine is
  int processes = 1;  ///< runs at a time
};

/// Contents of `file` if it has this key and was made with at most as many runs at a time: times measured on
/// a busier machine are not comparable. Empty otherwise.
std::optional<nlohmann::ordered_json> kept_run(const std::filesystem::path& file, const RunKey& key);

/// Writes `content`, an object, with this key. Throws SystemFailure when the file cannot be written.
void keep_run(const std::filesystem::path& file, const RunKey& key, const nlohmann::ordered_json& content);

/// JSON as the text of a file: indented, with invalid UTF-8 replaced.
std::string json_file_text(const nlohmann::ordered_json& json);

/// Name of the log that `file` is, without the ending of a log file: "intel" for "intel.clf.gz". Empty for
/// other endings.
std::optional<std::string> log_name_of(const std::string& file);

/// Processor and number of processors of this machine: "AMD EPYC, 2 processors".
std::string machine_text();

}  // namespace psi_slam
