// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/max_range_source.h"

#include <utility>

#include "logs/frames/look_over.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

void MaxRangeSource::look_ahead() {
  LookOver look_over(look_over_s_);
  try {
    while (!look_over.is_enough()) {
      const std::optional<Frame> frame = source_.next();
      if (!frame) break;
      study_.add(frame->scan);
      ++learned_ahead_;
      look_over.add_scan(frame->time_us);
    }
  } catch (const UserError&) {  // the source throws it again after these frames
  }
  max_ranges_ = study_.max_ranges();
}

void MaxRangeSource::begin() {
  if (study_log_)
    max_ranges_ = study_log_();
  else
    look_ahead();
  source_.rewind();
}

void MaxRangeSource::learn(const LaserScan& scan) {
  if (learned_ahead_ > 0) {
    --learned_ahead_;
    return;
  }
  study_.learn(scan, max_ranges_);
}

std::optional<Frame> MaxRangeSource::next() {
  if (!std::exchange(started_, true)) begin();
  std::optional<Frame> frame = source_.next();
  if (!frame) return frame;
  if (!study_log_) learn(frame->scan);
  apply_max_range(max_ranges_, frame->scan);
  return frame;
}

std::vector<std::string> MaxRangeSource::assumptions() const {
  std::vector<std::string> assumptions = source_.assumptions();
  for (const auto& [laser, max_range] : max_ranges_)
    if (max_range.is_surprise) assumptions.push_back(sentence_of(max_range));
  return assumptions;
}

}  // namespace psi_slam
