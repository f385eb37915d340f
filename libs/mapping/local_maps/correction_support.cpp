// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/correction_support.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

std::vector<double> scores_at(const ScoreGrid& grid, const ScanPoints& scan,
                              const mrpt::math::TPose2D& pose) {
  const double c = portable::cos(pose.phi);
  const double s = portable::sin(pose.phi);
  std::vector<double> scores;
  scores.reserve(scan.points.size());
  for (const auto& point : scan.points) {
    const auto x = static_cast<double>(point.x);
    const auto y = static_cast<double>(point.y);
    scores.push_back(grid.interpolate(pose.x + c * x - s * y, pose.y + s * x + c * y).value);
  }
  return scores;
}

}  // namespace

double mean_score(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& pose) {
  const std::vector<double> scores = scores_at(grid, scan, pose);
  return std::accumulate(scores.begin(), scores.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, scores.size()));
}

CorrectionScores scores_without_best_spot(const ScoreGrid& grid, const ScanPoints& scan,
                                          const mrpt::math::TPose2D& matched,
                                          const mrpt::math::TPose2D& held) {
  const std::vector<double> at_matched = scores_at(grid, scan, matched);
  const std::vector<double> at_held = scores_at(grid, scan, held);
  const auto in_spot = [&](std::size_t i, std::size_t middle) {
    const float dx = scan.points[i].x - scan.points[middle].x;
    const float dy = scan.points[i].y - scan.points[middle].y;
    return static_cast<double>(dx * dx + dy * dy) <= kPersonReach_m * kPersonReach_m;
  };
  std::size_t best = scan.points.size();
  double best_gain = 0;
  for (std::size_t middle = 0; middle < scan.points.size(); ++middle) {
    if (at_matched[middle] <= at_held[middle]) continue;
    double gain = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i)
      if (in_spot(i, middle)) gain += at_matched[i] - at_held[i];
    if (gain > best_gain) best_gain = gain, best = middle;
  }
  CorrectionScores scores;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (best < scan.points.size() && in_spot(i, best)) continue;
    scores.matched += at_matched[i];
    scores.held += at_held[i];
    ++count;
  }
  if (count == 0) return {};
  return {scores.matched / static_cast<double>(count), scores.held / static_cast<double>(count)};
}

}  // namespace psi_slam
