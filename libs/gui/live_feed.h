// SPDX-License-Identifier: BSD-3-Clause
// Frames of a robot that is driving, for a run that can be watched.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "live/live_source.h"
#include "session/session_input.h"

namespace psi_slam {

/// A live source that is opened later.
struct LiveStream {
  std::string name;  ///< names the log in reports
  /// Opens the source, as open_live() does.
  std::function<std::unique_ptr<FrameSource>(const LogOptions&, const LiveControl&)> open;
  /// File that records the scans for the case of a crash, see MappingSession::start_journal(); empty: none.
  std::filesystem::path journal{};
};

LiveStream live_stream(const LiveInput& input, std::filesystem::path journal = {});

/// How the mapping follows a live source.
struct LiveFigures {
  double scans_per_s = 0;  ///< scans mapped per second, over the last five seconds
  double delay_s = 0;      ///< time from the arrival of the newest mapped scan to its pose
  /// Largest delay of all scans that arrived later than a second after the first one; before such a scan, of
  /// all scans. The first scans arrive together, because they wait for LiveInput::look_over_s.
  double largest_delay_s = 0;
  std::size_t missed_deadlines = 0;  ///< see Mapper::missed_deadlines()
  std::size_t notices = 0;           ///< number of notices of the source so far
  std::string notice;                ///< the last notice, such as "listening on 127.0.0.1:5000"
};

/// Frames of a live source for a session, which receives them in a thread of its own (see open_input()).
/// Measures how the mapping follows them. Any thread may call any function.
class LiveFeed {
 public:
  explicit LiveFeed(LiveStream stream) : stream_(std::move(stream)) {}

  /// Returns the input of a session, which keeps the feed alive. Frames arrive after the input is opened.
  static SessionInput input(const std::shared_ptr<LiveFeed>& feed);

  /// Sets a function that is called after each arrival of a scan or of the end, from the thread that
  /// receives. Call before the input is opened.
  void set_observer(std::function<void()> arrived) { arrived_ = std::move(arrived); }

  /// Lets the source end. The scans that were received before still arrive.
  void end() { should_stop_ = true; }

  /// Returns whether, after `mapped` scans, the next scan has arrived or the source has ended. If so, the
  /// session does not wait for the source.
  bool has_news(std::size_t mapped) const;

  /// Measures the delay of the oldest scan that has no pose yet. Call once its pose is known.
  void note_pose(std::size_t missed_deadlines);

  LiveFigures figures() const;
  /// See LiveStream::journal.
  const std::filesystem::path& journal() const { return stream_.journal; }

 private:
  using Clock = std::chrono::steady_clock;
  class Source;

  void note_arrival();
  void note_end();
  void note(const std::string& notice);

  const LiveStream stream_;
  std::function<void()> arrived_;
  std::atomic<bool> should_stop_ = false;

  mutable std::mutex mutex_;                ///< protects the members below
  std::deque<Clock::time_point> arrivals_;  ///< of the scans without a pose
  std::deque<Clock::time_point> poses_;     ///< when poses became known, in the last seconds
  std::size_t arrived_scans_ = 0;
  Clock::time_point first_arrival_;
  bool begins_ = true;  ///< no scan that arrived later than the first ones has a pose
  bool ended_ = false;
  LiveFigures figures_;
};

}  // namespace psi_slam
