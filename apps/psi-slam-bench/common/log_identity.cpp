// SPDX-License-Identifier: BSD-3-Clause
#include "common/log_identity.h"

#include <nlohmann/json.hpp>

#include "base/file_checksum.h"

namespace psi_slam {

std::vector<LogIdentity> identities_of(const std::vector<BenchmarkLog>& logs) {
  std::vector<LogIdentity> identities;
  for (const BenchmarkLog& log : logs)
    identities.push_back({log.name, sha256_of_file(log.log), sha256_of_file(log.relations.value())});
  return identities;
}

std::string logs_markdown(const std::vector<LogIdentity>& logs,
                          const std::vector<std::string>& without_relations) {
  std::string text = "## Logs\n\n| log | SHA-256 of the log | SHA-256 of its relations |\n|---|---|---|\n";
  for (const LogIdentity& log : logs)
    text += "| " + log.name + " | `" + log.sha256 + "` | `" + log.relations_sha256 + "` |\n";
  for (const std::string& log : without_relations)
    text += "\n" + log + " has no relations and was left out.\n";
  return text;
}

nlohmann::ordered_json log_json(const LogIdentity& log) {
  return {{"name", log.name}, {"sha256", log.sha256}, {"relations_sha256", log.relations_sha256}};
}

}  // namespace psi_slam
