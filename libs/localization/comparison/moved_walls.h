// SPDX-License-Identifier: BSD-3-Clause
// Pairs of changed walls that are one wall at its old and at its new place. All lengths are in cells.
#pragma once

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace psi_slam {

using WallCells = std::vector<cv::Point>;  ///< columns and rows

/// A connected set of changed wall cells and its extent.
struct ChangedWall {
  WallCells cells;
  cv::Rect box;           ///< smallest rectangle with all cells
  cv::Vec3d scatter;      ///< sums of xx, xy and yy of the cells, relative to their mean
  cv::Point2d direction;  ///< unit vector along the main direction
  cv::Point2d from;       ///< ends along the main direction
  cv::Point2d to;

  double length() const;
};

/// Joins cells that touch or almost touch. Leaves out walls shorter than `min_length` and dotted ones.
std::vector<ChangedWall> connected_walls(const WallCells& cells, double min_length);

struct WallMoveLimits {
  double farthest = 0;    ///< longest shift
  double tolerance = 0;   ///< deviation of parallel walls from their usual distance
  double min_length = 0;  ///< shortest wall
};

struct MovedWall {
  ChangedWall wall;   ///< at its old place
  cv::Point2d shift;  ///< to its new place, perpendicular to the wall
};

/// Finds pairs of a vanished and an appeared wall that are one moved wall, and removes them from both lists.
/// The walls of a pair are parallel, beside each other, and one is at most twice as long as the other. Pairs
/// with the smallest distance are formed first. The part by which one wall exceeds the other stays in its
/// list. Exchanging both lists inverts the shifts.
std::vector<MovedWall> take_moved_walls(std::vector<ChangedWall>& vanished,
                                        std::vector<ChangedWall>& appeared, const WallMoveLimits& limits);

/// Returns the shift to cells of `others` that run parallel to the wall along at least half of its length.
/// Empty without such cells.
std::optional<cv::Point2d> shift_to_parallel(const ChangedWall& wall, const cv::Mat1b& others,
                                             const WallMoveLimits& limits);

}  // namespace psi_slam
