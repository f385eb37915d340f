// SPDX-License-Identifier: BSD-3-Clause
#include "session/read_ahead.h"

#include <gmock/gmock.h>

#include <chrono>
#include <future>
#include <thread>

#include "psi_slam/user_error.h"
#include "soon.h"

namespace psi_slam {
namespace {

/// Yields a number of frames, followed by the end or by the error of a malformed line.
class CountedFrames : public FrameSource {
 public:
  CountedFrames(std::size_t count, bool breaks_off) : count_(count), breaks_off_(breaks_off) {}

  std::optional<Frame> next() override {
    if (given_ == count_ && breaks_off_) throw UserError("line 8 is damaged");
    if (given_ == count_) return std::nullopt;
    Frame frame;
    frame.index = given_++;
    return frame;
  }

  double progress() const override { return static_cast<double>(given_) / static_cast<double>(count_); }
  std::vector<std::string> assumptions() const override { return {"the laser sees ahead"}; }

 private:
  std::size_t count_;
  bool breaks_off_;
  std::size_t given_ = 0;
};

/// Yields one frame as soon as it is sent.
class WaitingFrame : public FrameSource {
 public:
  explicit WaitingFrame(std::future<void> sent) : sent_(std::move(sent)) {}

  std::optional<Frame> next() override {
    if (!sent_.valid()) return std::nullopt;
    sent_.get();
    return Frame();
  }

  double progress() const override { return 0; }

 private:
  std::future<void> sent_;
};

TEST(ReadAhead, gives_all_frames_in_order_with_the_progress_of_those_taken) {
  for (const std::size_t capacity : {0, 1, 3, 2000}) {
    ReadAhead ahead(std::make_unique<CountedFrames>(1000, false), capacity);
    EXPECT_EQ(ahead.progress(), 0);
    for (std::size_t i = 0; i < 1000; ++i) {
      const auto frame = ahead.next();
      ASSERT_TRUE(frame.has_value());
      ASSERT_EQ(frame->index, i);
      ASSERT_EQ(ahead.progress(), static_cast<double>(i + 1) / 1000);
    }
    EXPECT_FALSE(ahead.next().has_value());
    EXPECT_FALSE(ahead.next().has_value()) << "next() returns nothing again after the end";
  }
}

TEST(ReadAhead, throws_the_sources_error_after_the_frames_before_it) {
  for (const std::size_t capacity : {1, 2, 3, 100}) {
    ReadAhead ahead(std::make_unique<CountedFrames>(5, true), capacity);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the reader waits for room
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(ahead.next().has_value());
    EXPECT_THROW(ahead.next(), UserError);
    EXPECT_THROW(ahead.next(), UserError);
    EXPECT_EQ(ahead.progress(), 1);
  }
}

TEST(ReadAhead, states_what_the_source_assumes_before_its_first_frame) {
  EXPECT_THAT(ReadAhead(std::make_unique<CountedFrames>(5, false)).assumptions(),
              testing::ElementsAre("the laser sees ahead"));
}

TEST(ReadAhead, is_ready_once_a_frame_or_the_end_is_read) {
  std::promise<void> sent;
  ReadAhead ahead(std::make_unique<WaitingFrame>(sent.get_future()));
  EXPECT_FALSE(ahead.is_ready());
  sent.set_value();
  EXPECT_TRUE(soon([&] { return ahead.is_ready(); }));
  EXPECT_TRUE(ahead.next());
  EXPECT_TRUE(soon([&] { return ahead.is_ready(); }));
  EXPECT_FALSE(ahead.next());
  EXPECT_TRUE(ahead.is_ready()) << "the end needs no waiting";
}

TEST(ReadAhead, can_be_destroyed_at_any_time) {
  for (int taken = 0; taken < 20; ++taken) {
    ReadAhead ahead(std::make_unique<CountedFrames>(1000, false), 4);
    for (int i = 0; i < taken; ++i) ahead.next();
  }
}

}  // namespace
}  // namespace psi_slam
