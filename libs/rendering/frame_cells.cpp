// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/frame_cells.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Steps along the longer axis of the line and computes the position across it at the middle of each step.
/// Fixed-point arithmetic makes all machines choose the same cells.
template <class Visit>
void walk(double along0, double across0, double along1, double across1, std::int64_t along_stride,
          std::int64_t across_stride, Visit visit) {
  constexpr int kFractionBits = 32;
  constexpr double kOne = 4294967296.0;
  const auto first = static_cast<std::int64_t>(along0);
  const auto last = static_cast<std::int64_t>(along1);
  const std::int64_t step = last < first ? -1 : 1;
  const double slope = along1 == along0 ? 0 : (across1 - across0) / (along1 - along0);
  const std::int64_t across_step = std::llround(slope * static_cast<double>(step) * kOne);
  std::int64_t across = std::llround((across0 + (static_cast<double>(first) + 0.5 - along0) * slope) * kOne);
  std::int64_t index = first * along_stride;
  for (std::int64_t i = std::abs(last - first); i > 0; --i) {
    visit(index + (across >> kFractionBits) * across_stride);
    index += step * along_stride;
    across += across_step;
  }
}

}  // namespace

const FrameCells& FrameCellFinder::find(const Frame& frame, const TPose2D& map_T_robot) {
  const std::vector<const Fan*>& fans = rays_.fans(frame, map_T_robot);
  begin(bounds_of(fans));
  for (const Fan* fan : fans)
    for (const Ray& ray : fan->rays) {
      if (!ray.hit) continue;
      const TPoint2D end = in_cells(ray.end);
      mark(static_cast<std::int64_t>(end.y) * width_ + static_cast<std::int64_t>(end.x), kHit);
    }
  for (const Fan* fan : fans)
    for (const Ray& ray : fan->rays)
      pass(in_cells(fan->start), in_cells(ray.end), [&](std::int64_t index) {
        if (!ray.returned)
          mark(index, kCleared);
        else if ((marks_[static_cast<std::size_t>(index)] & kHit) == 0)
          mark(index, kPassed);
      });
  for (const std::size_t index : touched_) {
    const auto width = static_cast<std::size_t>(width_);
    found_.cells.push_back({static_cast<std::int32_t>(index % width),
                            static_cast<std::int32_t>(index / width),
                            std::exchange(marks_[index], std::uint8_t{0})});
  }
  return found_;
}

/// Begins a frame with these bounds of its rays.
void FrameCellFinder::begin(const mrpt::math::TBoundingBox& bounds) {
  constexpr std::int64_t kMargin = 2;  // the digital line of a ray may end one cell beside the end point
  const auto cell = [this](double metres) { return std::llround(std::floor(metres / resolution_m_)); };
  found_.bounds = bounds;
  found_.x_min = cell(bounds.min.x) - kMargin;
  found_.y_min = cell(bounds.min.y) - kMargin;
  found_.cells.clear();
  touched_.clear();
  width_ = cell(bounds.max.x) + kMargin + 1 - found_.x_min;
  const std::int64_t height = cell(bounds.max.y) + kMargin + 1 - found_.y_min;
  const auto size = static_cast<std::size_t>(width_ * height);
  if (marks_.size() < size) marks_.resize(size);
}

void FrameCellFinder::mark(std::int64_t index, std::uint8_t mark) {
  std::uint8_t& marks = marks_[static_cast<std::size_t>(index)];
  if (marks == 0) touched_.push_back(static_cast<std::size_t>(index));
  marks |= mark;
}

/// Returns a point in cells, relative to the corner of the box.
TPoint2D FrameCellFinder::in_cells(const TPoint2D& point) const {
  return {point.x / resolution_m_ - static_cast<double>(found_.x_min),
          point.y / resolution_m_ - static_cast<double>(found_.y_min)};
}

/// Calls `visit` with the index of each cell of the digital line from `start` to `end`, except the cell of
/// `end`. Both points are in cells.
template <class Visit>
void FrameCellFinder::pass(const TPoint2D& start, const TPoint2D& end, Visit visit) const {
  if (std::abs(end.x - start.x) >= std::abs(end.y - start.y))
    walk(start.x, start.y, end.x, end.y, 1, width_, visit);
  else
    walk(start.y, start.x, end.y, end.x, width_, 1, visit);
}

}  // namespace psi_slam
