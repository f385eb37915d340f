// SPDX-License-Identifier: BSD-3-Clause
#include "session/open_input.h"

#include <utility>

#include "session/read_ahead.h"

namespace psi_slam {

std::unique_ptr<FrameSource> open_input(const SessionInput& input, const Settings& settings) {
  check(settings);
  auto source = input.open(log_options(settings));
  if (worker_threads(settings.run) == 1) return source;
  return std::make_unique<ReadAhead>(std::move(source));
}

}  // namespace psi_slam
