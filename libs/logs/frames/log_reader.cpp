// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/log_reader.h"

#include <algorithm>
#include <utility>

#include "logs/frames/look_over.h"

namespace psi_slam {

using Judgement = RepeatedScans::Judgement;

/// Returns whether the next frame must be read before the first frame ahead is given or left out: there is
/// none, or a laser has not shown yet whether its readings change.
bool LogReader::reads_on() {
  if (ahead_.empty()) return true;
  if (is_at_end_) return false;
  const auto is_awaited = [&](const Ahead& one) {
    return one.judgement == Judgement::kPerhaps && !repeated_.shows_change(one.frame.scan.laser) &&
           unchanging_.count(one.frame.scan.laser) == 0;
  };
  if (ahead_.size() < LookOver::kMostScans) return std::any_of(ahead_.begin(), ahead_.end(), is_awaited);
  for (const Ahead& one : ahead_)
    if (is_awaited(one)) unchanging_.insert(one.frame.scan.laser);
  return false;
}

std::optional<Frame> LogReader::next() {
  bool knows_turn = true;  // since the frame that was given last
  while (true) {
    while (reads_on()) {
      std::optional<Frame> frame;
      try {
        if (!failure_) frame = read_frame();
      } catch (...) {
        failure_ = std::current_exception();
      }
      is_at_end_ = !frame;
      if (is_at_end_) break;
      const Judgement judgement = repeated_.judge(*frame);
      ahead_.push_back({*std::move(frame), judgement});
    }
    if (ahead_.empty()) {
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      return std::nullopt;
    }
    Frame frame = std::move(ahead_.front().frame);
    const Judgement judgement = ahead_.front().judgement;
    ahead_.pop_front();
    const bool is_left_out = judgement == Judgement::kRepeats ||
                             (judgement == Judgement::kPerhaps && repeated_.shows_change(frame.scan.laser));
    if (!is_left_out) {
      if (!knows_turn) frame.imu_heading_rad.reset();
      frame.index = frames_given_++;
      return frame;
    }
    repeated_.count(frame);
    contents_.repeated_scans = repeated_.sentence();
    knows_turn = knows_turn && frame.imu_heading_rad;
  }
}

}  // namespace psi_slam
