// SPDX-License-Identifier: BSD-3-Clause
// What a person wants to see of a loop: the local map, and the node's scan on it where it was predicted and
// where it was matched.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "replay/replay_snapshot.h"
#include "rendering/map_image.h"

namespace psi_slam {

struct LoopPicture {
  MapRaster local_map;                       ///< dark where its scans hit something; in its own frame
  std::vector<mrpt::math::TPoint2D> before;  ///< the scan as predicted, in the local map's frame
  std::vector<mrpt::math::TPoint2D> after;   ///< as matched; empty where no match was found
};

/// Of a loop by its index; none when the snapshot does not hold what it takes.
std::optional<LoopPicture> loop_picture(const ReplaySnapshot& snapshot, std::size_t loop);

}  // namespace psi_slam
