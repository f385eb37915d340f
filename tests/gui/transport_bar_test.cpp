// SPDX-License-Identifier: BSD-3-Clause
#include "transport_bar.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<TimeUs> kStamps_us{5'000'000, 6'000'000, 8'000'000, 125'000'000};

TEST(TransportBar, shows_times_since_the_start_of_the_log) {
  EXPECT_EQ(log_time_text(kStamps_us, 2), "0:03 of 2:00");
  EXPECT_EQ(log_time_text({}, 0), "");
}

TEST(TransportBar, computes_the_remaining_time_from_the_speed) {
  EXPECT_EQ(replay_time_left_s(kStamps_us, 2, 1), 119);
  EXPECT_EQ(replay_time_left_s(kStamps_us, 2, 5), 119.0 / 5);
  EXPECT_EQ(replay_time_left_s(kStamps_us, 2, 0), 0) << "as fast as possible";
  EXPECT_EQ(replay_time_left_s(kStamps_us, 0, 1), 0);
  EXPECT_EQ(replay_time_left_s(kStamps_us, 4, 1), 0);
}

TEST(TransportBar, shows_the_longer_time_of_work_and_waiting) {
  ReplaySnapshot snapshot;
  snapshot.phase = ReplayPhase::kPlaying;
  snapshot.progress.share = 0.1;
  snapshot.progress.remaining_s = 20;
  EXPECT_THAT(progress_words(snapshot, 0), HasSubstr("0:20 left"));
  EXPECT_THAT(progress_words(snapshot, 119), HasSubstr("1:59 left"));
  EXPECT_THAT(progress_words(snapshot, 7), HasSubstr("0:20 left"));
  snapshot.phase = ReplayPhase::kFinalSearch;
  EXPECT_THAT(progress_words(snapshot, 119), Not(HasSubstr("1:59"))) << "the final search does not wait";
}

TEST(TransportBar, shows_the_scans_of_a_live_source) {
  ReplaySnapshot snapshot;
  snapshot.live = true;
  EXPECT_EQ(progress_words(snapshot, 0), "Connecting");
  snapshot.phase = ReplayPhase::kPlaying;
  EXPECT_EQ(progress_words(snapshot, 0), "Waiting for scans");
  SharedHistory<FrameRecord> frames;
  frames.push_back({});
  snapshot.frames = frames.view();
  EXPECT_EQ(progress_words(snapshot, 0), "Mapping live: 1 scans");
}

TEST(TransportBar, counts_unmatched_scans) {
  ReplaySnapshot snapshot;
  for (const ReplayPhase phase : {ReplayPhase::kPlaying, ReplayPhase::kFinished}) {
    snapshot.phase = phase;
    snapshot.unmatched = std::make_shared<UnmatchedScans>();
    EXPECT_THAT(progress_words(snapshot, 0), Not(HasSubstr("not matched")));
    snapshot.unmatched = std::make_shared<UnmatchedScans>(UnmatchedScans{12, {}});
    EXPECT_THAT(progress_words(snapshot, 0), HasSubstr("12 not matched"));
  }
}

}  // namespace
}  // namespace psi_slam
