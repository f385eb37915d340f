// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a log of any format that is read, which its content decides. Throws UserError when it cannot be
/// opened or is none of them, and when the options make no sense.
std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options = {});

}  // namespace psi_slam
