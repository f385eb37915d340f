// SPDX-License-Identifier: BSD-3-Clause
// Finds the pose of one finished map in another map of the same building. The walls of the smaller map are
// matched as one scan with the larger map: first near the given pose, then, if that does not fit, anywhere
// and at all headings in a coarse grid. The best pose is refined in the cells of the larger map.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <optional>

#include "base/degrees.h"

namespace psi_slam {

struct MapAlignmentOptions {
  /// Rough pose of the second map's frame in the first map; the maps are aligned near it. Empty: the frames
  /// may agree, and the whole map is searched if they do not.
  std::optional<mrpt::math::TPose2D> a_T_b;
  double near_m = 1.0;  ///< half-widths of the search near a pose
  double near_rad = radians_from_degrees(10.0L);
  double min_observed_share = 0.3;  ///< smallest share of a map's walls in space that the other map observed
  double min_agree = 0.5;           ///< smallest share of these walls that are walls of the other map, too
  /// The same share for maps whose frames may agree. If it is smaller, the whole map is searched.
  double min_agree_in_same_frame = 0.8;
  double max_ambiguity = 0.9;  ///< largest ratio of the next best alignment's response to the best response
};

/// Pose of map B in map A with its uncertainty.
struct MapAlignment {
  enum class Method {
    kGiven,     ///< the frames are equal by the user's word
    kNearby,    ///< found near the given pose, or near equal frames
    kWholeMap,  ///< found by a search of the whole map
  };

  Method method = Method::kGiven;
  mrpt::math::TPose2D a_T_b;    ///< pose of the frame of map B in the frame of map A
  mrpt::math::TPoint2D centre;  ///< mean of the matched walls in the frame of map A
  /// Covariance of the position of map B at `centre` and of its heading, along the axes of map A: m^2, m rad,
  /// rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double agree = 1;  ///< share of the walls in space that both maps observed which are walls in both maps
  /// Response of the next best alignment, divided by the best response. Empty unless the whole map was
  /// searched.
  std::optional<double> ambiguity;

  /// Standard deviation of the position of map B along the worse axis, `distance_m` away from `centre`.
  double sigma_m(double distance_m) const;
};

/// Aligns map B to map A. Deterministic. Throws UserError if the maps do not fit, if several alignments fit
/// about equally well, or if a map has too few walls; the text begins with a verb and lacks the names of the
/// maps, such as "does not fit".
MapAlignment align_maps(const mrpt::maps::COccupancyGridMap2D& a, const mrpt::maps::COccupancyGridMap2D& b,
                        const MapAlignmentOptions& options = {});

}  // namespace psi_slam
