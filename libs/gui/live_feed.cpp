// SPDX-License-Identifier: BSD-3-Clause
#include "gui/live_feed.h"

#include <algorithm>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::chrono::seconds kRatePeriod{5};
constexpr std::chrono::seconds kBeginning{1};  // the first scans arrive within this time

}  // namespace

/// Notes when frames arrive. Closes the source at its end, so that its port or sensors are free again.
class LiveFeed::Source : public FrameSource {
 public:
  Source(std::shared_ptr<LiveFeed> feed, std::unique_ptr<FrameSource> source)
      : feed_(std::move(feed)), source_(std::move(source)) {}

  std::optional<Frame> next() override {
    if (!source_) return std::nullopt;
    std::optional<Frame> frame;
    try {
      frame = source_->next();
    } catch (...) {
      close();
      throw;
    }
    frame ? feed_->note_arrival() : close();
    return frame;
  }
  double progress() const override { return 0; }
  SkippedLines skipped_lines() const override { return source_ ? source_->skipped_lines() : skipped_; }
  std::vector<std::string> assumptions() const override {
    return source_ ? source_->assumptions() : assumptions_;
  }

 private:
  void close() {
    skipped_ = source_->skipped_lines();
    assumptions_ = source_->assumptions();
    source_.reset();
    feed_->note_end();
  }

  std::shared_ptr<LiveFeed> feed_;
  std::unique_ptr<FrameSource> source_;  ///< null after its end
  SkippedLines skipped_;
  std::vector<std::string> assumptions_;
};

LiveStream live_stream(const LiveInput& input, std::filesystem::path journal) {
  return {name_of(input),
          [input](const LogOptions& options, const LiveControl& control) {
            return open_live(input, options, control);
          },
          std::move(journal)};
}

SessionInput LiveFeed::input(const std::shared_ptr<LiveFeed>& feed) {
  return SessionInput(feed->stream_.name, [feed](const LogOptions& options) {
    const LiveControl control{[feed] { return feed->should_stop_.load(); },
                              [feed](const std::string& notice) { feed->note(notice); }};
    return std::make_unique<Source>(feed, feed->stream_.open(options, control));
  });
}

bool LiveFeed::has_news(std::size_t mapped) const {
  const std::lock_guard lock(mutex_);
  return ended_ || arrived_scans_ > mapped;
}

void LiveFeed::note_pose(std::size_t missed_deadlines) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  poses_.push_back(now);
  while (poses_.front() < now - kRatePeriod) poses_.pop_front();
  figures_.missed_deadlines = missed_deadlines;
  if (arrivals_.empty()) return;
  const Clock::time_point arrival = arrivals_.front();
  arrivals_.pop_front();
  if (begins_ && arrival > first_arrival_ + kBeginning) {
    begins_ = false;
    figures_.largest_delay_s = 0;
  }
  figures_.delay_s = std::chrono::duration<double>(now - arrival).count();
  figures_.largest_delay_s = std::max(figures_.largest_delay_s, figures_.delay_s);
}

LiveFigures LiveFeed::figures() const {
  const std::lock_guard lock(mutex_);
  LiveFigures figures = figures_;
  const Clock::time_point begin = Clock::now() - kRatePeriod;
  const auto recent =
      std::count_if(poses_.begin(), poses_.end(), [&](const auto& time) { return time >= begin; });
  figures.scans_per_s = static_cast<double>(recent) / static_cast<double>(kRatePeriod.count());
  return figures;
}

void LiveFeed::note_arrival() {
  {
    const std::lock_guard lock(mutex_);
    arrivals_.push_back(Clock::now());
    if (arrived_scans_++ == 0) first_arrival_ = arrivals_.back();
  }
  if (arrived_) arrived_();
}

void LiveFeed::note_end() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  if (arrived_) arrived_();
}

void LiveFeed::note(const std::string& notice) {
  const std::lock_guard lock(mutex_);
  figures_.notice = notice;
  ++figures_.notices;
}

}  // namespace psi_slam
