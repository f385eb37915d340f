// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/graphslam/misc/CWindowManager.h>

#include <memory>

namespace psi_slam {

/// The window that MRPT's graph-slam engine draws into.
class GraphSlamWindow {
 public:
  /// Throws UserError if there is no display.
  GraphSlamWindow();
  ~GraphSlamWindow();

  mrpt::graphslam::CWindowManager& manager() { return manager_; }

  /// Returns when the user has closed the window or pressed Ctrl+C in it.
  void wait_until_closed();

 private:
  mrpt::graphslam::CWindowObserver observer_;
  std::unique_ptr<mrpt::gui::CDisplayWindow3D> window_;
  mrpt::graphslam::CWindowManager manager_;
};

}  // namespace psi_slam
