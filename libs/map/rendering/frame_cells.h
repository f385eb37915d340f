// SPDX-License-Identifier: BSD-3-Clause
// The cells that the scans of a frame touch. Cells have the same numbers in every map: cell (x, y) begins at
// x and y times the resolution. A frame at the same pose therefore touches the same cells wherever the map
// ends.
#pragma once

#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "logs/frames/digital_line.h"
#include "map/rendering/cell_box.h"
#include "map/rendering/scan_rays.h"
#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {

/// What the beams of a frame say about a cell, as a sum of flags.
enum CellMarks : std::uint8_t {
  kHit = 1,      ///< a beam ended in the cell
  kPassed = 2,   ///< a beam with a return crossed the cell, and none ended in it
  kCleared = 4,  ///< a beam without return crossed the cell
};

struct TouchedCell {
  std::int32_t x = 0;  ///< relative to FrameCells::x_min
  std::int32_t y = 0;  ///< relative to FrameCells::y_min
  std::uint8_t marks = 0;
};

/// Each touched cell once, in no particular order.
struct FrameCells {
  std::int64_t x_min = 0;
  std::int64_t y_min = 0;
  std::vector<TouchedCell> cells;
  mrpt::math::TBoundingBox bounds;  ///< of all rays, in metres
};

/// Finds the cells of frames.
class FrameCellFinder {
 public:
  FrameCellFinder(const GridMapOptions& options, double resolution_m)
      : rays_(options), resolution_m_(resolution_m) {}

  /// Returns the cells that a frame touches if the robot is at `map_T_robot`. The reference is valid until
  /// the next call. Throws as RayMaker::fans() does.
  const FrameCells& find(const Frame& frame, const mrpt::math::TPose2D& map_T_robot);

 private:
  void begin(const mrpt::math::TBoundingBox& bounds);
  void mark_end(const mrpt::math::TPoint2D& end);
  void mark_line(const mrpt::math::TPoint2D& start, const mrpt::math::TPoint2D& end, std::uint8_t mark);
  void make_room(std::size_t cells);

  RayMaker rays_;
  double resolution_m_;
  CellBox box_;
  int stride_bits_ = 0;  ///< 2 to this number is the smallest power of two that is not less than box_.width
  std::vector<std::uint8_t> marks_;   ///< of the cells of the box; all 0 between calls
  std::vector<std::size_t> touched_;  ///< indices of the marked cells, then room for more
  std::size_t num_touched_ = 0;
  LineFan passed_;   ///< lines of the beams with a return
  LineFan cleared_;  ///< and of the others
  FrameCells found_;
};

}  // namespace psi_slam
