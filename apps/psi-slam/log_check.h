// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <iosfwd>

#include "psi_slam/logs/log_options.h"

namespace psi_slam {

/// Prints what the log holds and what looks wrong, as sentences or as JSON. Throws UserError when the log
/// cannot be read.
void check_log(const std::filesystem::path& log, const LogOptions& options, bool as_json, std::ostream& out);

}  // namespace psi_slam
