// SPDX-License-Identifier: BSD-3-Clause
#include "live_status.h"

#include "base/number_text.h"

namespace psi_slam {

std::string live_status(const LiveFigures& figures) {
  const auto ms = [](double time_s) { return fixed_text(1e3 * time_s, 0) + " ms"; };
  return fixed_text(figures.scans_per_s, 1) + " scans/s   delay " + ms(figures.delay_s) + ", largest " +
         ms(figures.largest_delay_s) + "   " + std::to_string(figures.missed_deadlines) +
         (figures.missed_deadlines == 1 ? " missed deadline" : " missed deadlines");
}

}  // namespace psi_slam
