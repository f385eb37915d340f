// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/log_facts.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr double kLeastGap_s = 1.0;
constexpr double kGapPeriods = 10.0;

bool same_readings(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

void add_time_facts(const std::vector<FrameMark>& marks, TimeFacts& facts) {
  if (marks.empty()) return;
  facts.first_us = marks.front().time_us;
  facts.last_us = marks.back().time_us;
  const auto [earliest, latest] =
      std::minmax_element(marks.begin(), marks.end(),
                          [](const FrameMark& a, const FrameMark& b) { return a.time_us < b.time_us; });
  facts.duration_s = seconds(latest->time_us - earliest->time_us);
  const std::vector<double> periods_s = periods_between(marks);
  if (periods_s.empty()) return;
  facts.median_period_s = median(periods_s);
  for (const double period_s : periods_s) {
    if (period_s > std::max(kLeastGap_s, kGapPeriods * facts.median_period_s)) {
      ++facts.gaps;
      facts.largest_gap_s = std::max(facts.largest_gap_s, period_s);
    }
    if (period_s < 0) {
      ++facts.backward_steps;
      facts.largest_backward_step_s = std::max(facts.largest_backward_step_s, -period_s);
    }
  }
}

OdometryFacts odometry_facts(const std::vector<FrameMark>& marks) {
  OdometryFacts facts;
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const auto& before = marks[i - 1].odom_T_robot;
    const auto& now = marks[i].odom_T_robot;
    const double step_m = distance_m(before, now);
    const double turn_rad = std::abs(mrpt::math::wrapToPi(now.phi - before.phi));
    facts.path_length_m += step_m;
    facts.turned_rad += turn_rad;
    facts.largest_step_m = std::max(facts.largest_step_m, step_m);
    facts.largest_turn_rad = std::max(facts.largest_turn_rad, turn_rad);
  }
  return facts;
}

float median_below(const std::vector<std::size_t>& readings_by_cm, std::size_t returns) {
  std::size_t seen = 0;
  for (std::size_t cm = 0; cm < readings_by_cm.size(); ++cm) {
    seen += readings_by_cm[cm];
    if (2 * seen >= returns) return static_cast<float>(cm) / 100.0F;
  }
  return 0;
}

}  // namespace

void LogFactsCollector::add(const Frame& frame, float max_range_m, float min_range_m) {
  const LaserScan& scan = frame.scan;
  if (marks_.empty()) {
    facts_.beams = scan.ranges_m.size();
    facts_.first_bearing_rad = static_cast<double>(scan.bearings_rad->front());
    facts_.last_bearing_rad = static_cast<double>(scan.bearings_rad->back());
    facts_.robot_T_laser = scan.robot_T_laser;
  }
  if (!frame.has_odometry) ++facts_.scans_without_odometry;
  if (scan.ranges_m.size() != facts_.beams) ++facts_.scans_of_other_shape;
  if (!marks_.empty() && frame.time_us == marks_.back().time_us) {
    ++facts_.time.repeated_stamps;
    if (same_readings(scan.ranges_m, last_ranges_m_)) ++facts_.time.repeated_scans;
  }
  marks_.push_back({frame.time_us, frame.odom_T_robot});
  last_ranges_m_ = scan.ranges_m;
  RangeFacts& facts = facts_.ranges;
  facts.max_range_m = max_range_m;
  std::size_t returns = 0;
  for (const float range : scan.ranges_m) {
    if (std::isnan(range)) ++facts.invalid;
    if (!std::isfinite(range)) continue;
    if (range >= min_range_m && range < max_range_m) ++returns;
    const auto cm = static_cast<std::size_t>(static_cast<double>(range) * 100.0 + 0.5);  // below 1 km
    if (cm >= readings_by_cm_.size()) readings_by_cm_.resize(cm + 1);
    ++readings_by_cm_[cm];
  }
  facts.readings += scan.ranges_m.size();
  facts.returns += returns;
  if (returns == 0) ++facts.empty_scans;
}

LogFacts LogFactsCollector::facts() const {
  LogFacts facts = facts_;
  facts.scans = marks_.size();
  add_time_facts(marks_, facts.time);
  facts.odometry = odometry_facts(marks_);
  if (!readings_by_cm_.empty())
    facts.ranges.largest_reading_m = static_cast<float>(readings_by_cm_.size() - 1) / 100.0F;
  facts.ranges.median_return_m = median_below(readings_by_cm_, facts.ranges.returns);
  return facts;
}

std::vector<double> periods_between(const std::vector<FrameMark>& marks) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < marks.size(); ++i)
    periods_s.push_back(seconds(marks[i].time_us - marks[i - 1].time_us));
  return periods_s;
}

bool has_return(const Frame& frame) {
  bool any = false;
  for_each_scan(frame, {}, [&](const LaserScan& scan, const mrpt::math::TPose2D&) {
    any = any || std::any_of(scan.ranges_m.begin(), scan.ranges_m.end(),
                             [](float range_m) { return std::isfinite(range_m); });
  });
  return any;
}

std::string no_returns_text(const std::string& log, std::size_t scans) {
  return log + ": none of its " + std::to_string(scans) +
         " scans has a return between log.min_range_m and log.max_range_m. Correct these two options";
}

}  // namespace psi_slam
