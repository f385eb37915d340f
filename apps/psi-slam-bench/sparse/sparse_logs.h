// SPDX-License-Identifier: BSD-3-Clause
// The logs of the sparse benchmark: dense logs to thin, and logs that are sparse already.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"

namespace psi_slam {

struct SparseLogs {
  std::vector<BenchmarkLog> dense;  ///< logs in the folder with shipped settings
  std::vector<BenchmarkLog>
      sparse;  ///< logs without shipped settings, and those in the folder "sparse" in it
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
};

/// Logs in `data` and in its folder "sparse", by name; those in `names` if it is not empty. A log without
/// NAME.ini in `ini` has an empty path for it: it is mapped with the defaults. Throws UserError when `data`
/// is not a folder, for an unknown name, for a named log without relations, and when no log remains.
SparseLogs find_sparse_logs(const std::filesystem::path& data, const std::filesystem::path& ini,
                            const std::vector<std::string>& names = {});

}  // namespace psi_slam
