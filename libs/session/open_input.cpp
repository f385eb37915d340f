// SPDX-License-Identifier: BSD-3-Clause
#include "session/open_input.h"

#include <utility>

#include "exports/geo_tiff.h"
#include "session/read_ahead.h"

namespace psi_slam {

void check(const Settings& settings) {
  check_values(settings);
  check_epsg(settings.map_files.earth.epsg);
}

std::unique_ptr<FrameSource> open_input(const SessionInput& input, const Settings& settings) {
  check(settings);
  auto source = input.open(log_options(settings));
  if (worker_threads(settings.run) == 1) return source;
  return std::make_unique<ReadAhead>(std::move(source));
}

}  // namespace psi_slam
