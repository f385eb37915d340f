// SPDX-License-Identifier: BSD-3-Clause
#include "progress_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace psi_slam {
namespace {

using Phase = SessionProgress::Phase;

TEST(ProgressLine, shows_share_speed_and_time_left) {
  EXPECT_EQ(progress_text({Phase::kMapping, 0.43, 5876, 2100.4, 2.8, 3.7}),
            " 43 %   5876 scans   2100 scans/s   0:04 left");
  EXPECT_EQ(progress_text({Phase::kMapping, 0, 1, 10, 0.1, {}}), "  0 %   1 scans   10 scans/s");
  EXPECT_EQ(progress_text({Phase::kFinalSearch, 0.25, 5876, 10, 0.1, 61}),
            " 25 %   final loop search   1:01 left");
  EXPECT_EQ(progress_text({Phase::kPriorSearch, 0.25, 5876, 10, 0.1, 61}),
            " 25 %   aligning with the prior map   1:01 left");
  EXPECT_EQ(progress_text({Phase::kWriting, 0, 5876, 10, 0.1, {}}),
            "drawing the map and writing the results");
}

TEST(ProgressLine, shows_no_share_of_a_stream) {
  EXPECT_EQ(progress_text({Phase::kMapping, 0, 5876, 2100.4, 2.8, {}}, true), "5876 scans   2100 scans/s");
  EXPECT_EQ(progress_text({Phase::kFinalSearch, 0.25, 5876, 10, 0.1, 61}, true),
            " 25 %   final loop search   1:01 left");
}

TEST(ProgressLine, is_redrawn_for_every_phase_but_not_for_every_scan) {
  std::ostringstream terminal;
  ProgressLine line(terminal);
  for (std::size_t scan = 1; scan <= 1000; ++scan) line.show({Phase::kMapping, 0.001, scan, 1, 1, 1});
  line.show({Phase::kFinalSearch, 1, 1000, 1, 1, {}});
  line.show({Phase::kWriting, 1, 1000, 1, 1, {}});
  const std::string text = terminal.str();
  EXPECT_LT(std::count(text.begin(), text.end(), '\r'), 20);
  EXPECT_NE(text.find("final loop search"), std::string::npos);
  EXPECT_NE(text.find("writing"), std::string::npos);
}

TEST(ProgressLine, is_erased_at_its_end) {
  std::ostringstream terminal;
  { ProgressLine(terminal).show({Phase::kMapping, 0.5, 10, 1, 1, 1}); }
  EXPECT_EQ(terminal.str().substr(terminal.str().size() - 4), "\r\x1b[K");
  std::ostringstream untouched;
  { const ProgressLine line(untouched); }
  EXPECT_EQ(untouched.str(), "");
}

}  // namespace
}  // namespace psi_slam
