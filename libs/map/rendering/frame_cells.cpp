// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/frame_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace psi_slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

const FrameCells& FrameCellFinder::find(const Frame& frame, const TPose2D& map_T_robot) {
  const std::vector<const Fan*>& fans = rays_.fans(frame, map_T_robot);
  begin(bounds_of(fans));
  for (const Fan* fan : fans)
    for (const Ray& ray : fan->rays)
      if (ray.hit) mark_end(box_.in_cells(ray.end));
  passed_.clear();
  cleared_.clear();
  for (const Fan* fan : fans)
    for (const Ray& ray : fan->rays)
      mark_line(box_.in_cells(fan->start), box_.in_cells(ray.end), ray.returned ? kPassed : kCleared);
  const std::size_t stride = std::size_t{1} << stride_bits_;
  for (std::size_t i = 0; i < num_touched_; ++i) {
    const std::size_t index = touched_[i];
    const std::uint8_t marks = std::exchange(marks_[index], std::uint8_t{0});
    const bool is_hit = (marks & kHit) != 0;
    found_.cells.push_back({static_cast<std::int32_t>(index & (stride - 1)),
                            static_cast<std::int32_t>(index >> stride_bits_),
                            static_cast<std::uint8_t>(is_hit ? marks & ~kPassed : marks)});
  }
  return found_;
}

/// Begins a frame with these bounds of its rays.
void FrameCellFinder::begin(const mrpt::math::TBoundingBox& bounds) {
  box_ = cell_box(bounds, resolution_m_);
  found_.bounds = bounds;
  found_.x_min = box_.x_min;
  found_.y_min = box_.y_min;
  found_.cells.clear();
  num_touched_ = 0;
  stride_bits_ = 0;
  while (std::int64_t{1} << stride_bits_ < box_.width) ++stride_bits_;
  const auto size = static_cast<std::size_t>(box_.height << stride_bits_);
  if (marks_.size() < size) marks_.resize(size);
}

void FrameCellFinder::mark_end(const TPoint2D& end) {
  const auto index = (static_cast<std::size_t>(end.y) << stride_bits_) + static_cast<std::size_t>(end.x);
  make_room(1);
  if (marks_[index] == 0) touched_[num_touched_++] = index;
  marks_[index] |= kHit;
}

/// Marks each cell of the digital line from `start` to `end`, except the cell of `end`. Both points are in
/// cells.
void FrameCellFinder::mark_line(const TPoint2D& start, const TPoint2D& end, std::uint8_t mark) {
  const double length = std::max(std::abs(end.x - start.x), std::abs(end.y - start.y));
  make_room(static_cast<std::size_t>(length) + 2);
  // Local copies, because a write of a mark could change any member as far as the compiler knows.
  std::uint8_t* const marks = marks_.data();
  std::size_t* const touched = touched_.data();
  std::size_t num_touched = num_touched_;
  const auto visit = [&](std::int64_t index) {
    touched[num_touched] = static_cast<std::size_t>(index);
    num_touched += marks[index] == 0 ? 1 : 0;
    marks[index] |= mark;
  };
  (mark == kPassed ? passed_ : cleared_)
      .walk(digital_line(start, end, std::int64_t{1} << stride_bits_), visit);
  num_touched_ = num_touched;
}

/// Makes room for this number of further touched cells.
void FrameCellFinder::make_room(std::size_t cells) {
  if (touched_.size() < num_touched_ + cells) touched_.resize(2 * (num_touched_ + cells));
}

}  // namespace psi_slam
