// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/max_range_source.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "frames_in_memory.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

constexpr float kCode_m = 20;

/// Frames of a laser that is stated to see 30 m. From the frame `first_code` on, it writes a code instead of
/// each reading of more than 6 m.
std::vector<Frame> frames_with_code(std::size_t first_code) {
  const SimulatedRun run = round_trips(1);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    Frame frame;
    frame.index = i;
    frame.time_us = static_cast<TimeUs>(200'000 * i);
    frame.scan = run.scan(i);
    for (float& range_m : frame.scan.ranges_m)
      if (range_m > 6 && i >= first_code) range_m = kCode_m;
    frame.scan.max_range_m = 30;
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::unique_ptr<FrameSource> in_memory(std::vector<Frame> frames) {
  return std::make_unique<FramesInMemory>(std::move(frames));
}

bool has_code(const LaserScan& scan) {
  return std::find(scan.ranges_m.begin(), scan.ranges_m.end(), kCode_m) != scan.ranges_m.end();
}

/// Reads all frames. Expects that they are those of `frames` in their order, apart from codes. Returns the
/// number of frames with a code.
std::size_t frames_with_code_in(FrameSource& source, const std::vector<Frame>& frames) {
  std::size_t with_code = 0;
  for (const Frame& expected : frames) {
    const auto frame = source.next();
    EXPECT_TRUE(frame);
    if (!frame) return with_code;
    EXPECT_EQ(frame->index, expected.index);
    with_code += has_code(frame->scan) ? 1 : 0;
    std::vector<float> expected_m = expected.scan.ranges_m;
    if (!has_code(frame->scan)) std::replace(expected_m.begin(), expected_m.end(), kCode_m, HUGE_VALF);
    EXPECT_EQ(frame->scan.ranges_m, expected_m);
  }
  EXPECT_FALSE(source.next());
  return with_code;
}

TEST(MaxRangeSource, a_late_code_of_a_file_is_no_return_from_the_first_scan) {
  const std::vector<Frame> frames = frames_with_code(300);
  std::size_t studies = 0;
  MaxRangeSource source(in_memory(frames), [&] {
    ++studies;
    return study_max_ranges(*in_memory(frames));
  });
  EXPECT_EQ(studies, 0U) << "opening a log takes no time";
  EXPECT_EQ(frames_with_code_in(source, frames), 0U);
  EXPECT_EQ(studies, 1U);
  EXPECT_THAT(source.assumptions(), testing::ElementsAre(testing::HasSubstr("writes 20.00 m")));
}

TEST(MaxRangeSource, a_stream_is_looked_over) {
  const std::vector<Frame> frames = frames_with_code(0);
  MaxRangeSource at_length(in_memory(frames), 60.0);
  EXPECT_EQ(frames_with_code_in(at_length, frames), 0U);
  EXPECT_THAT(at_length.assumptions(), testing::ElementsAre(testing::HasSubstr("writes 20.00 m")));
  MaxRangeSource brief(in_memory(frames), 0.0);
  EXPECT_GT(frames_with_code_in(brief, frames), 0U) << "one scan shows no code";
}

TEST(MaxRangeSource, a_code_that_appears_later_in_a_stream_applies_from_then_on) {
  const std::vector<Frame> frames = frames_with_code(150);
  MaxRangeSource source(in_memory(frames), 5.0);
  const std::size_t before = frames_with_code_in(source, frames);
  EXPECT_GE(before, MaxRangeStudy::kLeastViews - 1);
  EXPECT_LT(before, 100U);
  EXPECT_THAT(source.assumptions(), testing::ElementsAre(testing::HasSubstr("writes 20.00 m")));
}

TEST(MaxRangeSource, frames_of_the_look_over_count_once) {
  const std::vector<Frame> frames = frames_with_code(0);
  MaxRangeStudy study;
  for (const Frame& frame : frames) study.add(frame.scan);
  for (const double look_over_s : {0.0, 3.0, 1000.0}) {
    MaxRangeSource source(in_memory(frames), look_over_s);
    frames_with_code_in(source, frames);
    EXPECT_EQ(source.assumptions(), std::vector<std::string>{sentence_of(study.max_ranges().at(0))});
  }
}

TEST(MaxRangeSource, a_source_without_codes_stays_unchanged) {
  const std::vector<Frame> frames = frames_with_code(100'000);
  MaxRangeSource source(in_memory(frames), [] { return MaxRanges(); });
  EXPECT_EQ(frames_with_code_in(source, frames), 0U);
  EXPECT_THAT(source.assumptions(), testing::IsEmpty());
}

}  // namespace
}  // namespace psi_slam
