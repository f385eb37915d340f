// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "psi_slam/log_options.h"

namespace psi_slam {

/// Prints what the log holds and what looks wrong, as sentences or as JSON. Returns where and why
/// the log breaks off, a sentence; empty when it could be read to its end. Throws UserError when nothing of
/// it can be read.
std::string check_log(const std::filesystem::path& log, const LogOptions& options, bool as_json,
                      std::ostream& out);

}  // namespace psi_slam
