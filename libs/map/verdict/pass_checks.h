// SPDX-License-Identifier: BSD-3-Clause
// Compares each view of a map with views of other passes at the same place, and with the views just before it
// on the path.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "map/verdict/map_views.h"
#include "map/verdict/scan_comparison.h"

namespace psi_slam {

struct PassCheckOptions {
  double reach_m = 3.0;         ///< largest distance between compared views
  double pass_apart_m = 8.0;    ///< least path between two passes of one run
  std::size_t passes = 3;       ///< largest number of other passes that a view is compared with
  std::size_t views_back = 3;   ///< number of views back on the path of the comparison within a pass
  std::size_t min_points = 15;  ///< comparisons of fewer points count as none
  double unknown_m = 1.0;       ///< displacement if the scans do not fit even after the alignment
  double lever_m = 2.0;         ///< a turn of the alignment by 1 rad counts like this displacement
  ScanComparisonOptions scans;
};

/// Comparison of two views of a map.
struct PassCheck {
  std::size_t view = 0;    ///< index of the view
  std::size_t other = 0;   ///< index of the other view
  bool same_pass = false;  ///< whether both views belong to one pass
  ScanComparison scans;
  double error_m = 0;  ///< estimated displacement between both views, at most unknown_m
  /// Whether the scans fit after the alignment, so that the displacement was measured. False if the views see
  /// different scenes: the displacement is too large, or the scene changed.
  bool fits_if_moved = false;
  /// Whether the scans differ because the scene changed between both views, not because of wrong poses: no
  /// motion makes the scans fit, and in every direction most points confirm the poses of the map.
  /// check_passes() also requires that other views of both passes fit within pass_apart_m of path. It then
  /// sets error_m to 0, because such a pair of views says nothing about the poses.
  bool scene_changed = false;
};

/// Whether the scans fit after the alignment, and see enough common points to judge it.
bool fits_after_alignment(const ScanComparison& scans, const PassCheckOptions& options);

/// Compares two views; empty if they see too few common points.
std::optional<PassCheck> compare_views(const std::vector<MapView>& views, std::size_t view, std::size_t other,
                                       bool same_pass, const PassCheckOptions& options);

/// Compares the views. At one place, the first eight views with similar headings serve for comparison with
/// all views, so that the work grows linearly with the path. The checks are ordered by PassCheck::view.
std::vector<PassCheck> check_passes(const std::vector<MapView>& views, const PassCheckOptions& options = {});

/// Returns for each view the largest error of its checks with other passes; empty for a view that no other
/// pass overlaps in the same scene.
std::vector<std::optional<double>> errors_of_views(std::size_t views, const std::vector<PassCheck>& checks);

}  // namespace psi_slam
