// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/gyroscope_headings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::size_t kKeptSamples = 10'000;
constexpr std::size_t kMaxWaiting = 1000;

}  // namespace

double vertical_rate_radps(const mrpt::poses::CPose3D& robot_T_gyroscope,
                           const mrpt::math::TVector3D& rate_radps) {
  constexpr double kHorizontal = 1e-6;  // largest vertical component of a horizontal axis
  double vertical_radps = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double component = robot_T_gyroscope.getRotationMatrix()(2, axis);
    if (std::abs(component) > kHorizontal)
      vertical_radps += component * rate_radps[static_cast<std::size_t>(axis)];
  }
  return vertical_radps;
}

void GyroscopeHeadings::add_rate(TimeUs time_us, double rate_radps) {
  if (!(std::abs(rate_radps) <= kMaxRate_radps)) return;
  measures_ = measures_ || rate_radps != 0;
  Sample added{time_us, rate_radps, 0, 0};
  if (!samples_.empty()) {
    const Sample last = samples_.back();
    const double passed_s = seconds(time_us - last.time_us);
    if (passed_s <= 0 && passed_s >= -kMaxGap_s) return;
    const bool is_gap = passed_s < 0 || passed_s > kMaxGap_s;
    added.part = last.part + (is_gap ? 1 : 0);
    added.heading_rad = last.heading_rad + (is_gap ? 0 : passed_s * (last.rate_radps + rate_radps) / 2);
    if (passed_s < 0) samples_.clear();
  }
  samples_.push_back(added);
  if (samples_.size() > kKeptSamples) samples_.pop_front();
}

std::optional<GyroscopeHeadings::Sample> GyroscopeHeadings::sample_at(TimeUs time_us) const {
  const auto after =
      std::lower_bound(samples_.begin(), samples_.end(), time_us,
                       [](const Sample& sample, TimeUs time) { return sample.time_us < time; });
  if (after == samples_.end()) return std::nullopt;
  if (after->time_us == time_us) return *after;
  if (after == samples_.begin()) return std::nullopt;
  const Sample& before = *std::prev(after);
  if (before.part != after->part) return std::nullopt;
  const double fraction = seconds(time_us - before.time_us) / seconds(after->time_us - before.time_us);
  Sample sample = before;
  sample.time_us = time_us;
  sample.heading_rad += fraction * (after->heading_rad - before.heading_rad);
  return sample;
}

bool GyroscopeHeadings::must_wait(const Frame& scan) const {
  const bool is_reached = !samples_.empty() && samples_.back().time_us >= scan.time_us;
  return !is_reached && !ended_ && scans_.size() <= kMaxWaiting &&
         std::abs(seconds(scans_.back().time_us - scan.time_us)) < kMaxWait_s;
}

std::optional<Frame> GyroscopeHeadings::take() {
  if (scans_.empty() || must_wait(scans_.front())) return std::nullopt;
  Frame frame = std::move(scans_.front());
  scans_.pop_front();
  const auto last_part = last_parts_.find(frame.scan.laser);
  const auto sample = measures_ ? sample_at(frame.time_us) : std::nullopt;
  const bool continues = sample && (last_part == last_parts_.end() || last_part->second == sample->part);
  if (continues) {
    frame.imu_heading_rad = sample->heading_rad;
    last_parts_[frame.scan.laser] = sample->part;
  } else if (last_part != last_parts_.end()) {
    last_parts_.erase(last_part);
  }
  return frame;
}

}  // namespace psi_slam
