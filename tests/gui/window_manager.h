// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// True if main() has started a window manager for this test.
bool has_window_manager();

/// Waits up to 10 s until the window manager manages the screen. Returns false if it does not.
bool wait_for_window_manager();

}  // namespace psi_slam
