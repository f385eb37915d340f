// SPDX-License-Identifier: BSD-3-Clause
// Which logs figures are of: by the checksums of their files, for pages and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"

namespace psi_slam {

struct LogIdentity {
  std::string name;
  std::string sha256;            ///< of the log's file
  std::string relations_sha256;  ///< of its relations
};

/// Of logs with their relations. Throws UserError when a file cannot be read.
std::vector<LogIdentity> identities_of(const std::vector<BenchmarkLog>& logs);

/// A section of a page, with the logs that were left out because they have no relations.
std::string logs_markdown(const std::vector<LogIdentity>& logs,
                          const std::vector<std::string>& without_relations);

/// {"name": ..., "sha256": ..., "relations_sha256": ...}
nlohmann::ordered_json log_json(const LogIdentity& log);

}  // namespace psi_slam
