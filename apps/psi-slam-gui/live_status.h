// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "gui/live_feed.h"

namespace psi_slam {

/// Text for the status bar, such as "10.0 scans/s   delay 3 ms, largest 41 ms   0 missed deadlines".
std::string live_status(const LiveFigures& figures);

}  // namespace psi_slam
