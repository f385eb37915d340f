// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/max_range_study.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/number_text.h"
#include "logs/frames/laser_readings.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

// Readings that differ by less than 3 % are similar.
constexpr double kSimilar = 0.97;

/// Returns the cell of a range: the cells are 1 cm wide, and centred at whole centimetres.
std::size_t cell_of(double range_m) {
  return static_cast<std::size_t>(std::lround(100 * range_m));
}

float largest_reading_m(const std::vector<float>& ranges_m) {
  float largest_m = 0;
  for (const float range_m : ranges_m)
    if (std::isfinite(range_m)) largest_m = std::max(largest_m, range_m);
  return largest_m;
}

/// Returns whether most readings that are clearly below the largest one changed since the last view.
bool is_new_view(const std::vector<float>& view_m, const std::vector<float>& ranges_m, float largest_m) {
  const double below_m = kSimilar * static_cast<double>(largest_m);
  std::size_t compared = 0;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < std::min(view_m.size(), ranges_m.size()); ++i) {
    const auto range_m = static_cast<double>(ranges_m[i]);
    if (!(range_m < below_m)) continue;
    ++compared;
    if (!(std::abs(range_m - static_cast<double>(view_m[i])) <= (1 - kSimilar) * range_m)) ++changed;
  }
  return view_m.empty() || 2 * changed > compared;
}

}  // namespace

void MaxRangeStudy::add(const LaserScan& scan) {
  const float largest_m = largest_reading_m(scan.ranges_m);
  Laser& laser = lasers_[scan.laser];
  laser.robot_T_laser = scan.robot_T_laser;
  laser.stated_max_range_m = std::max(laser.stated_max_range_m, static_cast<double>(scan.max_range_m));
  if (largest_m == 0 || !is_new_view(laser.view_m, scan.ranges_m, largest_m)) return;
  laser.view_m = scan.ranges_m;
  ++laser.views;
  ++views_;
  laser.cells.resize(std::max(laser.cells.size(), cell_of(static_cast<double>(largest_m)) + 1));
  for (const float range_m : scan.ranges_m) {
    if (!std::isfinite(range_m)) continue;
    Cell& cell = laser.cells[cell_of(static_cast<double>(range_m))];
    ++cell.readings;
    if (cell.last_view == laser.views) continue;
    cell.last_view = laser.views;
    ++cell.views;
  }
}

/// Returns the cell of a code, by the first `end` cells; empty if they show none.
std::optional<std::size_t> MaxRangeStudy::code_before(const std::vector<Cell>& cells, std::size_t end) {
  end = std::min(end, cells.size());
  std::size_t largest = end;
  while (largest > 0 && cells[largest - 1].views < kLeastViews) --largest;
  if (largest == 0) return std::nullopt;
  const auto first = static_cast<std::size_t>(std::ceil(kSimilar * static_cast<double>(largest - 1)));
  std::size_t readings = 0;
  std::size_t code = first;
  for (std::size_t i = first; i < end; ++i) {
    readings += cells[i].readings;
    if (cells[i].readings > cells[code].readings) code = i;
  }
  if (2 * cells[code].readings <= readings) return std::nullopt;
  return code;
}

/// Returns the smallest of the codes that the first `end` cells show.
std::optional<std::size_t> MaxRangeStudy::smallest_code_before(const std::vector<Cell>& cells,
                                                               std::size_t end) {
  std::optional<std::size_t> smallest;
  for (auto code = code_before(cells, end); code; code = code_before(cells, *code)) smallest = code;
  return smallest;
}

MaxRange MaxRangeStudy::max_range_of(const Laser& laser) {
  const bool states_maximum = laser.stated_max_range_m > 0;
  const double default_m = states_maximum ? laser.stated_max_range_m : kUnstatedMaxRange_m;
  MaxRange found{laser.robot_T_laser, default_m, laser.stated_max_range_m, 0, false};
  auto code = smallest_code_before(laser.cells, laser.cells.size());
  if (!code && !states_maximum) code = smallest_code_before(laser.cells, cell_of(kUnstatedMaxRange_m));
  if (!code) return found;
  const double code_m = static_cast<double>(*code) / 100;
  found.code_m = code_m;
  found.is_surprise = states_maximum || code_m < kUnstatedMaxRange_m;
  if (states_maximum || code_m != kUnstatedMaxRange_m) found.max_range_m = code_m - 0.005;  // of its cell
  return found;
}

void MaxRangeStudy::learn(const LaserScan& scan, MaxRanges& max_ranges) {
  const std::size_t before = views_;
  add(scan);
  if (views_ != before) max_ranges = this->max_ranges();
}

MaxRanges MaxRangeStudy::max_ranges() const {
  MaxRanges all;
  for (const auto& [number, laser] : lasers_) all.emplace(number, max_range_of(laser));
  return all;
}

MaxRanges study_max_ranges(FrameSource& log) {
  MaxRangeStudy study;
  try {
    while (const std::optional<Frame> frame = log.next()) study.add(frame->scan);
  } catch (const UserError&) {  // damage is reported where the log is mapped or checked
  }
  return study.max_ranges();
}

void apply_max_range(const MaxRanges& max_ranges, LaserScan& scan) {
  const auto known = max_ranges.find(scan.laser);
  const MaxRange range = known == max_ranges.end() ? MaxRange() : known->second;
  const bool states_maximum = scan.max_range_m > 0;
  if (states_maximum && range.code_m == 0) return;
  const auto max_range_m = static_cast<float>(range.max_range_m);
  scan.max_range_m = states_maximum ? std::min(scan.max_range_m, max_range_m) : max_range_m;
  mark_no_returns(scan.ranges_m, 0, static_cast<double>(scan.max_range_m));
}

std::string sentence_of(const MaxRange& max_range) {
  const mrpt::math::TPose2D& mount = max_range.robot_T_laser;
  return "the laser at x " + fixed_text(mount.x, 2) + " m, y " + fixed_text(mount.y, 2) + " m writes " +
         fixed_text(max_range.code_m, 2) + " m for \"no return\", although the log states " +
         (max_range.stated_max_range_m > 0
              ? "a maximum range of " + fixed_text(max_range.stated_max_range_m, 2) + " m"
              : "no maximum range") +
         ", so such readings and longer ones count as no returns. State another maximum with log.max_range_m";
}

}  // namespace psi_slam
