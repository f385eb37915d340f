// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/scan_sampling.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "logs/frames/pose_operations.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kSameHeading_rad = 0.35;
constexpr double kElsewhere_m = 0.05;
constexpr double kElsewhere_rad = 0.05;
constexpr double kSameSpan_rad = 0.05;  // lasers that count beams inexactly vary by less

// Distance by odometry between two frames.
double odometry_m(const FrameMark& a, const FrameMark& b) {
  return distance_m(a.odom_T_robot, b.odom_T_robot);
}

std::vector<double> ways_m(const std::vector<FrameMark>& marks) {
  std::vector<double> ways(marks.size(), 0);
  for (std::size_t i = 1; i < marks.size(); ++i) ways[i] = ways[i - 1] + odometry_m(marks[i - 1], marks[i]);
  return ways;
}

/// Returns the next frame at another position or heading. A waiting robot thus counts once.
std::size_t next_elsewhere(const std::vector<FrameMark>& marks, const std::vector<double>& headings_rad,
                           std::size_t frame) {
  std::size_t next = frame + 1;
  while (next < marks.size() && odometry_m(marks[frame], marks[next]) < kElsewhere_m &&
         std::abs(headings_rad[next] - headings_rad[frame]) < kElsewhere_rad)
    ++next;
  return next;
}

/// Returns the first frame after `frame` that is at least `distance` or `turn_rad` away; the number of frames
/// without such a frame.
std::size_t next_after_motion(const std::vector<FrameMark>& marks, std::size_t frame, double distance,
                              double turn_rad) {
  std::size_t next = frame + 1;
  while (next < marks.size()) {
    const TPose2D motion = odometry_between(marks, {frame, next});
    if (!(motion.norm() < distance && std::abs(motion.phi) < turn_rad)) break;
    ++next;
  }
  return next;
}

std::int64_t cell_key(double x, double y, double cell_m) {
  const auto column = static_cast<std::int64_t>(std::floor(x / cell_m));
  const auto row = static_cast<std::int64_t>(std::floor(y / cell_m));
  return column * 1'000'003 + row;
}

}  // namespace

TPose2D odometry_between(const std::vector<FrameMark>& marks, const FramePair& pair) {
  return between(marks[pair.first].odom_T_robot, marks[pair.second].odom_T_robot);
}

std::vector<double> unwrapped_headings(const std::vector<FrameMark>& marks) {
  std::vector<double> headings_rad(marks.size(), 0);
  for (std::size_t i = 1; i < marks.size(); ++i) {
    headings_rad[i] =
        headings_rad[i - 1] + mrpt::math::wrapToPi(marks[i].odom_T_robot.phi - marks[i - 1].odom_T_robot.phi);
  }
  return headings_rad;
}

std::vector<std::size_t> frames_in_motion(const std::vector<FrameMark>& marks, std::size_t count) {
  std::vector<std::size_t> frames;
  if (marks.size() < 2) return frames;
  const std::vector<double> ways = ways_m(marks);
  std::vector<double> turns(marks.size(), 0);
  for (std::size_t i = 1; i < marks.size(); ++i) {
    turns[i] = turns[i - 1] +
               std::abs(mrpt::math::wrapToPi(marks[i].odom_T_robot.phi - marks[i - 1].odom_T_robot.phi));
  }
  const bool moves = ways.back() > 0 || turns.back() > 0;
  const auto activity = [&](std::size_t i) {
    if (!moves) return static_cast<double>(i) / static_cast<double>(marks.size());
    return (ways.back() > 0 ? ways[i] / ways.back() : 0) + (turns.back() > 0 ? turns[i] / turns.back() : 0);
  };
  const double total = activity(marks.size() - 1);
  std::size_t frame = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = total * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    while (frame + 2 < marks.size() && activity(frame + 1) < wanted) ++frame;
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  return frames;
}

std::vector<FramePair> pairs_by_motion(const std::vector<FrameMark>& marks, double distance, double turn_rad,
                                       std::size_t most) {
  std::vector<FramePair> pairs;
  for (std::size_t first = 0; first < marks.size();) {
    const std::size_t second = next_after_motion(marks, first, distance, turn_rad);
    if (second < marks.size()) pairs.push_back({first, second});
    first = second;
  }
  return thinned(pairs, most);
}

std::vector<FramePair> overlapping_pairs(const std::vector<FrameMark>& marks, double distance,
                                         double turn_rad, std::size_t most) {
  constexpr double kShare = 0.2;  // of the motion of a pair, after which the next pair begins
  std::vector<FramePair> pairs;
  for (std::size_t first = 0; first < marks.size();) {
    const std::size_t second = next_after_motion(marks, first, distance, turn_rad);
    if (second == marks.size()) break;
    pairs.push_back({first, second});
    first = next_after_motion(marks, first, kShare * distance, kShare * turn_rad);
  }
  return thinned(pairs, most);
}

std::vector<FramePair> pairs_by_turn(const std::vector<FrameMark>& marks, double min_turn_rad,
                                     double max_turn_rad, double distance, std::size_t most) {
  const std::vector<double> headings = unwrapped_headings(marks);
  std::vector<FramePair> pairs;
  for (std::size_t first = 0; first < marks.size();) {
    std::size_t second = first + 1;
    while (second < marks.size() && odometry_m(marks[first], marks[second]) <= distance &&
           std::abs(headings[second] - headings[first]) < min_turn_rad)
      ++second;
    const bool found = second < marks.size() && odometry_m(marks[first], marks[second]) <= distance &&
                       std::abs(headings[second] - headings[first]) <= max_turn_rad;
    if (found) pairs.push_back({first, second});
    first = found ? second : next_elsewhere(marks, headings, first);
  }
  return thinned(pairs, most);
}

std::vector<FramePair> revisiting_pairs(const std::vector<FrameMark>& marks, double distance, double turn_rad,
                                        double way_m, std::size_t most) {
  const std::vector<double> ways = ways_m(marks);
  const double spacing_m = distance;  // least path between two frames that are checked
  std::unordered_map<std::int64_t, std::vector<std::size_t>> visited;
  std::vector<FramePair> pairs;
  double last_way = -spacing_m;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (ways[i] - last_way < spacing_m) continue;
    last_way = ways[i];
    const TPose2D& here = marks[i].odom_T_robot;
    std::optional<FramePair> nearest;
    double nearest_m = distance;
    for (const double dx : {-distance, 0.0, distance}) {
      for (const double dy : {-distance, 0.0, distance}) {
        const auto cell = visited.find(cell_key(here.x + dx, here.y + dy, distance));
        if (cell == visited.end()) continue;
        for (const std::size_t before : cell->second) {
          const double apart = odometry_m(marks[before], marks[i]);
          const double turn = std::abs(mrpt::math::wrapToPi(here.phi - marks[before].odom_T_robot.phi));
          if (ways[i] - ways[before] < way_m || apart > nearest_m || turn > turn_rad) continue;
          nearest_m = apart;
          nearest = {before, i};
        }
      }
    }
    if (nearest) pairs.push_back(*nearest);
    visited[cell_key(here.x, here.y, distance)].push_back(i);
  }
  return thinned(pairs, most);
}

std::vector<std::vector<std::size_t>> full_turns(const std::vector<FrameMark>& marks, double step_rad,
                                                 double distance, std::size_t most) {
  const std::vector<double> headings = unwrapped_headings(marks);
  const auto off_full_turn = [&](std::size_t first, std::size_t last) {
    return std::abs(std::abs(headings[last] - headings[first]) - 2 * M_PI);
  };
  std::vector<std::vector<std::size_t>> turns;
  for (std::size_t first = 0; first < marks.size() && turns.size() < most;) {
    std::size_t last = first;
    for (std::size_t i = first + 1; i < marks.size() && odometry_m(marks[first], marks[i]) <= distance; ++i) {
      if (off_full_turn(first, i) > kSameHeading_rad) continue;
      if (last == first || off_full_turn(first, i) < off_full_turn(first, last)) last = i;
    }
    if (last == first) {
      first = next_elsewhere(marks, headings, first);
      continue;
    }
    std::vector<std::size_t> frames{first};
    for (std::size_t i = first + 1; i < last; ++i)
      if (std::abs(headings[i] - headings[frames.back()]) >= step_rad) frames.push_back(i);
    frames.push_back(last);
    turns.push_back(frames);
    first = last;
  }
  return turns;
}

bool have_same_span(const LaserScan& a, const LaserScan& b) {
  if (a.ranges_m.size() == b.ranges_m.size()) return true;  // the removal of motion changes bearings, too
  const auto span_rad = [](const LaserScan& scan) {
    if (!scan.bearings_rad || scan.bearings_rad->empty()) return 0.0;
    const std::vector<float>& bearings = *scan.bearings_rad;
    return std::abs(static_cast<double>(bearings.back() - bearings.front()));
  };
  return std::abs(span_rad(a) - span_rad(b)) <= kSameSpan_rad;
}

void ScanLibrary::want(const std::vector<std::size_t>& indices) {
  for (const std::size_t index : indices) want(index);
}

void ScanLibrary::want(const std::vector<FramePair>& pairs) {
  for (const FramePair& pair : pairs) {
    want(pair.first);
    want(pair.second);
  }
}

void ScanLibrary::fetch(const std::filesystem::path& path, const LogOptions& options,
                        const ShareObserver& progress) {
  const auto log = open_log(path, options);
  auto wanted = scans_.begin();
  while (wanted != scans_.end()) {
    auto frame = log->next();
    if (!frame) return;
    if (progress) progress(log->progress());
    if (frame->index != wanted->first) continue;
    wanted->second = std::move(frame->scan);
    ++wanted;
  }
}

void ScanLibrary::take(const std::vector<const LaserScan*>& scans) {
  for (auto& [index, scan] : scans_) scan = *scans.at(index);
}

}  // namespace psi_slam
