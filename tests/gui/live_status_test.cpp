// SPDX-License-Identifier: BSD-3-Clause
#include "live_status.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(LiveStatus, shows_rate_delay_and_missed_deadlines) {
  LiveFigures figures;
  figures.scans_per_s = 9.6;
  figures.delay_s = 0.0031;
  figures.largest_delay_s = 0.041;
  EXPECT_EQ(live_status(figures), "9.6 scans/s   delay 3 ms, largest 41 ms   0 missed deadlines");
  figures.missed_deadlines = 1;
  EXPECT_EQ(live_status(figures), "9.6 scans/s   delay 3 ms, largest 41 ms   1 missed deadline");
}

}  // namespace
}  // namespace psi_slam
