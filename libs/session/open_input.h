// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "psi_slam/frame_source.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

/// As the settings say, read ahead in a thread of its own where there are several. Throws UserError when the
/// settings contradict each other or it cannot be read.
std::unique_ptr<FrameSource> open_input(const SessionInput& input, const Settings& settings);

}  // namespace psi_slam
