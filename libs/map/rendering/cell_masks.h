// SPDX-License-Identifier: BSD-3-Clause
// Masks of the cells of a map, 255 where a statement is true and 0 elsewhere, and what one map shows near the
// walls of another one. All lengths are in cells.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace psi_slam {

inline constexpr double kRounding_cells = 1e-4;  ///< of lengths in cells: MRPT's resolution is a float

/// Returns the value of an expression of masks, such as `a & b`.
inline cv::Mat1b mask(const cv::Mat& expression) {
  return expression;
}

inline cv::Mat1b empty_mask(int rows, int columns) {
  return cv::Mat1b(rows, columns, std::uint8_t{0});
}

/// Returns the distance of each cell from the nearest of `cells`; far more than the size of the map if there
/// are none.
cv::Mat1f distance_from(const cv::Mat1b& cells);

/// Returns the free cells with free space around them: at least 90 % of the cells in the square that reaches
/// as far as the tolerance, and at least to the neighbours.
cv::Mat1b clear_cells(const cv::Mat1b& free, double tolerance_cells);

}  // namespace psi_slam
