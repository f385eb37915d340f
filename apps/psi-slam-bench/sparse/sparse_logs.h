// SPDX-License-Identifier: BSD-3-Clause
// The logs of the sparse benchmark: dense logs to thin, and logs that are sparse as recorded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"

namespace psi_slam {

struct SparseLogs {
  std::vector<BenchmarkLog> dense;  ///< logs of the folder that have settings NAME.ini
  /// Logs of the folder without settings NAME.ini, and all logs in its subfolder "sparse".
  std::vector<BenchmarkLog> sparse;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
};

/// Logs in `data` and in its folder "sparse", ordered by name; only the logs in `names` if it is not empty. A
/// log without NAME.ini in `ini` has an empty BenchmarkLog::ini and is mapped with the defaults. Throws
/// UserError when `data` is not a folder, for an unknown name, for a named log without relations, and when no
/// log remains.
SparseLogs find_sparse_logs(const std::filesystem::path& data, const std::filesystem::path& ini,
                            const std::vector<std::string>& names = {});

}  // namespace psi_slam
