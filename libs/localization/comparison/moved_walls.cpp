// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/moved_walls.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>
#include <tuple>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

constexpr int kBridgedCells = 2;        // changed cells this far apart belong to one change
constexpr double kLeastFilled = 0.5;    // share of the length of a change that has cells; others are dotted
constexpr double kLeastParallel = 0.5;  // share of the length of either wall that runs beside the other
constexpr double kLeastCosine = 0.866;  // of the angle between a wall's old and new direction, 30 degrees

cv::Point2d main_direction(const cv::Vec3d& scatter) {
  const double direction_rad = 0.5 * portable::atan2(2 * scatter[1], scatter[0] - scatter[2]);
  return {portable::cos(direction_rad), portable::sin(direction_rad)};
}

ChangedWall wall_of(WallCells cells) {
  cv::Point2d mean(0, 0);
  for (const cv::Point& cell : cells) mean += cv::Point2d(cell);
  mean /= static_cast<double>(cells.size());
  ChangedWall wall;
  for (const cv::Point& cell : cells) {
    const cv::Point2d offset = cv::Point2d(cell) - mean;
    wall.scatter += cv::Vec3d(offset.x * offset.x, offset.x * offset.y, offset.y * offset.y);
  }
  wall.direction = main_direction(wall.scatter);
  double least = 0;
  double most = 0;
  for (const cv::Point& cell : cells) {
    const double along = wall.direction.dot(cv::Point2d(cell) - mean);
    least = std::min(least, along);
    most = std::max(most, along);
  }
  wall.box = cv::boundingRect(cells);
  wall.from = mean + least * wall.direction;
  wall.to = mean + most * wall.direction;
  wall.cells = std::move(cells);
  return wall;
}

/// Places of cells across a direction, by their places along it.
using Profile = std::map<int, std::vector<double>>;

int place_of(const cv::Point& cell, const cv::Point2d& direction) {
  return static_cast<int>(std::floor(direction.dot(cv::Point2d(cell))));
}

Profile profile_of(const WallCells& cells, const cv::Point2d& direction) {
  Profile profile;
  for (const cv::Point& cell : cells)
    profile[place_of(cell, direction)].push_back(direction.cross(cv::Point2d(cell)));
  return profile;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return values.size() % 2 == 1 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double filled_length(const ChangedWall& wall) {
  return static_cast<double>(profile_of(wall.cells, wall.direction).size());
}

/// Where two walls run side by side.
struct SideBySide {
  double distance = 0;   ///< from the first to the second wall, signed
  std::set<int> places;  ///< along the direction

  bool covers(const Profile& profile) const {
    return static_cast<double>(places.size()) >= kLeastParallel * static_cast<double>(profile.size());
  }
};

SideBySide side_by_side(const Profile& first, const Profile& second, const WallMoveLimits& limits) {
  std::map<int, double> distances;
  for (const auto& [place, across_first] : first) {
    const auto found = second.find(place);
    if (found == second.end()) continue;
    double nearest = limits.farthest + 1;
    for (const double from : across_first)
      for (const double to : found->second)
        if (std::abs(to - from) < std::abs(nearest)) nearest = to - from;
    if (std::abs(nearest) <= limits.farthest) distances[place] = nearest;
  }
  SideBySide result;
  if (distances.empty()) return result;
  std::vector<double> values;
  for (const auto& [place, distance] : distances) values.push_back(distance);
  result.distance = median(std::move(values));
  for (const auto& [place, distance] : distances)
    if (std::abs(distance - result.distance) <= limits.tolerance) result.places.insert(place);
  return result;
}

cv::Point2d across(const cv::Point2d& direction, double distance) {
  return {-direction.y * distance, direction.x * distance};
}

bool are_near(const cv::Rect& box, const cv::Rect& other, double farthest) {
  const int margin = static_cast<int>(farthest) + 1;
  return (cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) & other)
             .area() > 0;
}

/// A vanished wall and an appeared wall that may be the same wall.
struct Pair {
  std::size_t vanished = 0;
  std::size_t appeared = 0;
  cv::Point2d direction;  ///< of both walls together
  SideBySide beside;
  cv::Point middle;  ///< twice the middle of both boxes, for an order that does not depend on the lists

  bool operator<(const Pair& other) const {
    const auto key = [](const Pair& pair) {
      return std::make_tuple(std::abs(pair.beside.distance), -static_cast<double>(pair.beside.places.size()),
                             pair.middle.x, pair.middle.y);
    };
    return key(*this) < key(other);
  }
};

std::optional<Pair> pair_of(const std::vector<ChangedWall>& vanished, std::size_t i,
                            const std::vector<ChangedWall>& appeared, std::size_t j,
                            const WallMoveLimits& limits) {
  const ChangedWall& old_wall = vanished[i];
  const ChangedWall& new_wall = appeared[j];
  if (!are_near(old_wall.box, new_wall.box, limits.farthest) ||
      std::abs(old_wall.direction.dot(new_wall.direction)) < kLeastCosine)
    return std::nullopt;
  Pair pair;
  pair.vanished = i;
  pair.appeared = j;
  pair.direction = main_direction(old_wall.scatter + new_wall.scatter);
  const Profile old_profile = profile_of(old_wall.cells, pair.direction);
  const Profile new_profile = profile_of(new_wall.cells, pair.direction);
  pair.beside = side_by_side(old_profile, new_profile, limits);
  if (!pair.beside.covers(old_profile) || !pair.beside.covers(new_profile)) return std::nullopt;
  pair.middle = old_wall.box.tl() + old_wall.box.br() + new_wall.box.tl() + new_wall.box.br();
  return pair;
}

/// Parts of a wall beside its other place, and the rest of it.
struct SplitWall {
  WallCells moved;
  std::vector<ChangedWall> rest;
};

SplitWall split(const ChangedWall& wall, const Pair& pair, double min_length) {
  SplitWall result;
  WallCells rest;
  for (const cv::Point& cell : wall.cells)
    (pair.beside.places.count(place_of(cell, pair.direction)) > 0 ? result.moved : rest).push_back(cell);
  result.rest = connected_walls(rest, min_length);
  return result;
}

/// Replaces the walls of which the rest is known.
void replace_by_rest(std::vector<ChangedWall>& walls, std::map<std::size_t, SplitWall>& by_index) {
  std::vector<ChangedWall> result;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const auto found = by_index.find(i);
    if (found == by_index.end())
      result.push_back(std::move(walls[i]));
    else
      std::move(found->second.rest.begin(), found->second.rest.end(), std::back_inserter(result));
  }
  walls = std::move(result);
}

}  // namespace

double ChangedWall::length() const {
  return distance_m(from, to) + 1;
}

std::vector<ChangedWall> connected_walls(const WallCells& cells, double min_length) {
  if (cells.empty()) return {};
  const cv::Rect box = cv::boundingRect(cells);
  const cv::Point corner = box.tl() - cv::Point(kBridgedCells, kBridgedCells);
  cv::Mat1b bridged(box.height + 2 * kBridgedCells, box.width + 2 * kBridgedCells, std::uint8_t{0});
  for (const cv::Point& cell : cells) bridged(cell - corner) = 255;
  const int side = 1 + kBridgedCells;
  cv::dilate(bridged, bridged, cv::getStructuringElement(cv::MORPH_RECT, {side, side}));
  cv::Mat1i labels;
  std::vector<WallCells> parts(static_cast<std::size_t>(cv::connectedComponents(bridged, labels, 8, CV_32S)));
  for (const cv::Point& cell : cells) parts[static_cast<std::size_t>(labels(cell - corner))].push_back(cell);
  std::vector<ChangedWall> walls;
  for (WallCells& part : parts) {
    if (part.empty()) continue;
    ChangedWall wall = wall_of(std::move(part));
    const double length = wall.length();
    if (length >= min_length && filled_length(wall) >= kLeastFilled * length)
      walls.push_back(std::move(wall));
  }
  return walls;
}

std::vector<MovedWall> take_moved_walls(std::vector<ChangedWall>& vanished,
                                        std::vector<ChangedWall>& appeared, const WallMoveLimits& limits) {
  std::vector<MovedWall> moved;
  while (true) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < vanished.size(); ++i)
      for (std::size_t j = 0; j < appeared.size(); ++j)
        if (std::optional<Pair> pair = pair_of(vanished, i, appeared, j, limits))
          pairs.push_back(*std::move(pair));
    if (pairs.empty()) return moved;
    std::stable_sort(pairs.begin(), pairs.end());
    std::map<std::size_t, SplitWall> split_vanished;
    std::map<std::size_t, SplitWall> split_appeared;
    for (const Pair& pair : pairs) {
      if (split_vanished.count(pair.vanished) > 0 || split_appeared.count(pair.appeared) > 0) continue;
      SplitWall& old_wall = split_vanished[pair.vanished] =
          split(vanished[pair.vanished], pair, limits.min_length);
      split_appeared[pair.appeared] = split(appeared[pair.appeared], pair, limits.min_length);
      moved.push_back({wall_of(std::move(old_wall.moved)), across(pair.direction, pair.beside.distance)});
    }
    replace_by_rest(vanished, split_vanished);
    replace_by_rest(appeared, split_appeared);
  }
}

std::optional<cv::Point2d> shift_to_parallel(const ChangedWall& wall, const cv::Mat1b& others,
                                             const WallMoveLimits& limits) {
  const int margin = static_cast<int>(limits.farthest) + 1;
  const cv::Rect area = cv::Rect(wall.box.x - margin, wall.box.y - margin, wall.box.width + 2 * margin,
                                 wall.box.height + 2 * margin) &
                        cv::Rect(0, 0, others.cols, others.rows);
  WallCells near;
  cv::findNonZero(others(area), near);
  for (cv::Point& cell : near) cell += area.tl();
  const Profile profile = profile_of(wall.cells, wall.direction);
  const SideBySide beside = side_by_side(profile, profile_of(near, wall.direction), limits);
  if (!beside.covers(profile)) return std::nullopt;
  return across(wall.direction, beside.distance);
}

}  // namespace psi_slam
