// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/rewindable_source.h"

#include <gmock/gmock.h>

#include "log_files.h"

namespace psi_slam {
namespace {

/// Yields frames with the indices 0 to 9, and then fails if wanted.
class TenFrames : public FrameSource {
 public:
  explicit TenFrames(bool fails) : fails_(fails) {}
  std::optional<Frame> next() override {
    if (next_ == 10 && fails_) throw UserError("damaged");
    if (next_ == 10) return std::nullopt;
    Frame frame;
    frame.index = next_++;
    return frame;
  }
  double progress() const override { return 0.1 * static_cast<double>(next_); }

 private:
  bool fails_;
  std::size_t next_ = 0;
};

class RewindableSourceTest : public testing::TestWithParam<bool> {};

TEST_P(RewindableSourceTest, yields_the_same_frames_progress_and_error_after_rewinding) {
  const bool fails = GetParam();
  for (const std::size_t read_before : {0U, 3U, 10U, 11U}) {
    RewindableSource source(std::make_unique<TenFrames>(fails));
    for (std::size_t i = 0; i < read_before; ++i) {
      if (i == 10 && fails)
        EXPECT_THROW(source.next(), UserError);
      else
        EXPECT_EQ(source.next().has_value(), i < 10);
    }
    source.rewind();
    EXPECT_EQ(source.progress(), 0);
    for (std::size_t i = 0; i < 10; ++i) {
      const auto frame = source.next();
      ASSERT_TRUE(frame.has_value());
      EXPECT_EQ(frame->index, i);
      EXPECT_DOUBLE_EQ(source.progress(), 0.1 * static_cast<double>(i + 1));
    }
    if (fails)
      EXPECT_THROW(source.next(), UserError);
    else
      EXPECT_FALSE(source.next().has_value());
  }
}

INSTANTIATE_TEST_SUITE_P(Ends, RewindableSourceTest, testing::Bool());

}  // namespace
}  // namespace psi_slam
