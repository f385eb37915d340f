// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/cell_masks.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "matching/cell.h"

namespace psi_slam {
namespace {

// More than half, so that free space on one side of a wall is no evidence; less than one, because maps have
// unseen specks.
constexpr double kLeastClear = 0.9;

}  // namespace

cv::Mat1f distance_from(const cv::Mat1b& cells) {
  cv::Mat1f distance;
  cv::distanceTransform(~cells, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

cv::Mat1b clear_cells(const cv::Mat1b& free, double tolerance_cells) {
  const int reach = std::clamp(floor_to_int(tolerance_cells), 1, std::max(free.cols, free.rows));
  const int side = 2 * reach + 1;
  cv::Mat1i count;
  cv::boxFilter(free & 1, count, CV_32S, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
  return mask(free & (count >= kLeastClear * side * side));
}

}  // namespace psi_slam
