// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace psi_slam {

/// The name of the log that a file is, if its ending is one of a log's: "intel" for "intel.clf.gz".
std::optional<std::string> log_name_of(const std::string& file);

}  // namespace psi_slam
