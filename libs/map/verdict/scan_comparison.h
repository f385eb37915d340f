// SPDX-License-Identifier: BSD-3-Clause
// Compares the surfaces that one scan saw with the beams of another scan at the poses of the map. Both scans
// saw the same walls if the map is right. If it is wrong, one scan saw free space where the other saw a wall,
// or both saw parallel walls.
//
// The beam of the other scan towards a surface point p ends at q. The offset (q - p) . n along the normal n
// of the surface is near zero if both saw one wall. A few steps of point-to-line alignment with these pairs
// (Chen and Medioni 1992, with projective association) estimate by how much the scan is displaced.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>

#include "map/verdict/map_views.h"

namespace psi_slam {

/// Weight of the prior at the start pose of the alignment, in points: it keeps the pose along a corridor.
/// With fewer points that face a direction, the scan leaves that direction open.
inline constexpr double kPriorPoints = 2;

struct ScanComparisonOptions {
  double margin_m = 0.1;          ///< offsets up to this count as the same wall
  double max_offset_m = 1.0;      ///< largest distance between the two images of a doubled wall
  double max_range_m = 15;        ///< beams of the other scan beyond this are not compared
  double least_incidence = 0.25;  ///< least cosine between a beam and the normal of the surface
};

struct ScanComparison {
  std::size_t points = 0;        ///< surface points of the scan in the view of the other scan
  std::size_t same = 0;          ///< points where both saw the same wall
  std::size_t seen_through = 0;  ///< points where the other scan saw free space around and behind the point
  double offset_m = 0;           ///< median size of the offsets up to max_offset_m; 0 without such points
  /// Displacement of the scan relative to the other scan, by the alignment; along a corridor it is unknown
  /// and counts as zero.
  double displacement_m = 0;
  double turn_rad = 0;                ///< rotation of the alignment
  mrpt::math::TPose2D map_T_moved;    ///< pose of the robot at the scan after the alignment
  std::size_t compared_if_moved = 0;  ///< same + seen_through after the alignment
  double same_if_moved = 0;           ///< share of same / (same + seen_through) after the alignment
  /// Whether, of the points that face any one direction, more see the same wall than not. If the scan were
  /// displaced, those that face the displacement would not.
  bool is_held = false;
  mrpt::math::TPoint2D at;  ///< a point on a wall that is seen through or doubled, in the map

  /// Share of the compared points that the other scan saw through, in [0, 1].
  double seen_through_share() const {
    const std::size_t compared = same + seen_through;
    return compared == 0 ? 0 : static_cast<double>(seen_through) / static_cast<double>(compared);
  }
};

/// Compares the surfaces of `view` with the beams of `other`. People and other small things have no straight
/// surface and are left out. Beams without return are left out, because glass and black surfaces return none.
ScanComparison compare_scans(const MapView& view, const MapView& other,
                             const ScanComparisonOptions& options = {});

}  // namespace psi_slam
