// SPDX-License-Identifier: BSD-3-Clause
#include "gui/live_feed.h"

#include <gtest/gtest.h>

#include <thread>

#include "frames_in_memory.h"
#include "sender.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

/// Waits for its end without yielding a frame.
class SilentSource : public FrameSource {
 public:
  explicit SilentSource(LiveControl control) : control_(std::move(control)) {}
  std::optional<Frame> next() override {
    soon([this] { return control_.should_stop(); });
    return std::nullopt;
  }
  double progress() const override { return 0; }
  std::vector<std::string> assumptions() const override { return {"no odometry"}; }

 private:
  LiveControl control_;
};

TEST(LiveFeed, measures_the_delay_from_arrival_to_pose) {
  const auto feed =
      std::make_shared<LiveFeed>(LiveStream{"memory", [](const LogOptions&, const LiveControl&) {
                                              return std::make_unique<FramesInMemory>(std::vector<Frame>(2));
                                            }});
  const SessionInput input = LiveFeed::input(feed);
  EXPECT_EQ(names_of(input.logs()), "memory");
  EXPECT_FALSE(feed->has_news(0)) << "the source is not open";
  const auto frames = open_input(input, Settings()).frames;
  ASSERT_TRUE(soon([&] { return feed->has_news(1); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(frames->next());
  feed->note_pose(1);
  const LiveFigures first = feed->figures();
  EXPECT_GE(first.delay_s, 0.02);
  EXPECT_EQ(first.largest_delay_s, first.delay_s);
  EXPECT_EQ(first.missed_deadlines, 1U);
  EXPECT_GT(first.scans_per_s, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_TRUE(frames->next());
  feed->note_pose(1);
  EXPECT_GT(feed->figures().delay_s, first.delay_s) << "it arrived with the first one";
  EXPECT_EQ(feed->figures().largest_delay_s, feed->figures().delay_s);
  EXPECT_FALSE(frames->next());
  EXPECT_TRUE(soon([&] { return feed->has_news(2); })) << "the end is news";
}

TEST(LiveFeed, the_largest_delay_leaves_out_the_first_scans) {
  std::atomic<bool> second_scan_comes = false;
  class Source : public FrameSource {
   public:
    explicit Source(const std::atomic<bool>& comes) : comes_(comes) {}
    std::optional<Frame> next() override {
      if (given_ > 0) soon([this] { return comes_.load(); });
      return ++given_ > 2 ? std::nullopt : std::optional<Frame>(Frame());
    }
    double progress() const override { return 0; }

   private:
    const std::atomic<bool>& comes_;
    int given_ = 0;
  };
  const auto feed =
      std::make_shared<LiveFeed>(LiveStream{"memory", [&](const LogOptions&, const LiveControl&) {
                                              return std::make_unique<Source>(second_scan_comes);
                                            }});
  const auto frames = open_input(LiveFeed::input(feed), Settings()).frames;
  EXPECT_TRUE(frames->next());
  std::this_thread::sleep_for(std::chrono::milliseconds(1010));
  feed->note_pose(0);
  EXPECT_GT(feed->figures().largest_delay_s, 1);
  second_scan_comes = true;
  EXPECT_TRUE(frames->next());
  feed->note_pose(0);
  EXPECT_LT(feed->figures().largest_delay_s, 1);
}

TEST(LiveFeed, ends_a_silent_source_and_passes_its_notices) {
  std::atomic<int> arrivals = 0;
  const auto feed =
      std::make_shared<LiveFeed>(LiveStream{"silence", [](const LogOptions&, const LiveControl& control) {
                                              control.notify("waiting");
                                              return std::make_unique<SilentSource>(control);
                                            }});
  feed->set_observer([&] { ++arrivals; });
  const auto frames = open_input(LiveFeed::input(feed), Settings()).frames;
  EXPECT_EQ(feed->figures().notice, "waiting");
  EXPECT_EQ(feed->figures().notices, 1U);
  EXPECT_FALSE(feed->has_news(0));
  feed->end();
  EXPECT_FALSE(frames->next());
  EXPECT_TRUE(feed->has_news(0));
  EXPECT_EQ(arrivals, 1);
  EXPECT_EQ(frames->assumptions(), std::vector<std::string>{"no odometry"}) << "the source is closed";
}

}  // namespace
}  // namespace psi_slam
