// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace psi_slam {

/// Ends a live source, and receives its notices.
struct LiveControl {
  /// Returns whether the source shall end. Called often, from the threads of the source.
  std::function<bool()> should_stop;
  /// Takes sentences such as "listening on 127.0.0.1:5000", without full stop. Called from the threads of the
  /// source.
  std::function<void(const std::string&)> notify;
};

}  // namespace psi_slam
