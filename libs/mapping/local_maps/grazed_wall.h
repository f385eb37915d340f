// SPDX-License-Identifier: BSD-3-Clause
// Far ahead in a corridor, neighbouring beams graze a wall metres apart. Four successive ends on a straight
// line tell that they lie on one wall.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cstddef>
#include <optional>

namespace psi_slam {

inline constexpr std::size_t kWallEnds = 4;

struct GrazedWall {
  mrpt::math::TPoint2D normal;  ///< unit vector
  double offset_m = 0;          ///< largest distance of an end from the line through the outer ends
};

/// Returns the wall through successive ends of beams. Empty if an end is more than 4 cm off the line through
/// the outer ones, if the ends turn back, or if the widest gap between them is more than 16 times the
/// narrowest: any line passes through ends on one object, such as a post.
std::optional<GrazedWall> grazed_wall(const std::array<mrpt::math::TPoint2D, kWallEnds>& ends);

}  // namespace psi_slam
