// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/sparse_logs.h"

#include <algorithm>

#include "psi_slam/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

SparseLogs find_sparse_logs(const fs::path& data, const fs::path& ini,
                            const std::vector<std::string>& names) {
  SparseLogs found;
  std::vector<std::string> known;
  const auto sort_in = [&](BenchmarkLog log, bool sparse) {
    known.push_back(log.name);
    const bool named = std::find(names.begin(), names.end(), log.name) != names.end();
    if (!named && !names.empty()) return;
    if (named && !log.relations)
      throw UserError(log.log.string() + " has no relations to measure its error: expected " + log.name +
                      ".relations beside it");
    if (!log.relations) return found.without_relations.push_back(log.name);
    (sparse || log.ini.empty() ? found.sparse : found.dense).push_back(std::move(log));
  };
  for (BenchmarkLog& log : logs_in_folder(data, ini)) sort_in(std::move(log), false);
  if (fs::is_directory(data / "sparse"))
    for (BenchmarkLog& log : logs_in_folder(data / "sparse", ini)) sort_in(std::move(log), true);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw UserError("--logs: there is no log called " + name + " in " + data.string());
  if (found.dense.empty() && found.sparse.empty())
    throw UserError("no log can be evaluated: expected NAME.relations beside a log in " + data.string() +
                    " or in its folder sparse");
  return found;
}

}  // namespace psi_slam
