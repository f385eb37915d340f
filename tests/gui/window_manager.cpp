// SPDX-License-Identifier: BSD-3-Clause
#include "window_manager.h"

#include <X11/Xlib.h>

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace psi_slam {

bool has_window_manager() {
  return std::getenv("PSI_SLAM_GUI_TEST_WINDOW_MANAGER") != nullptr;
}

bool wait_for_window_manager() {
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr) throw std::runtime_error("no display");
  const Atom manager = XInternAtom(display, "WM_S0", False);  // its owner manages the first screen
  bool runs = false;
  for (int tries = 0; tries < 200 && !runs; ++tries) {
    runs = XGetSelectionOwner(display, manager) != 0;
    if (!runs) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  XCloseDisplay(display);
  return runs;
}

}  // namespace psi_slam
