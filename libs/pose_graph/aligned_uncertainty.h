// SPDX-License-Identifier: BSD-3-Clause
// Uncertainty of the shape of a map: that of the positions after the best rigid alignment with the truth. The
// covariance relative to the first scan grows with the distance from it, because an error of the heading
// there turns the whole map. This error is in the frame of the map, not in its shape.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Returns the standard deviation of the position of each of the given nodes in metres: the square root of
/// the trace of its covariance, with the model of shared errors. The map is aligned by least squares over the
/// given nodes. Linearised: a displacement of all nodes that is a rigid motion does not count. Empty for
/// nodes whose place in the map is unknown (see placed_part()), and for all nodes if the constraints do not
/// determine the poses.
std::vector<std::optional<double>> aligned_sigmas_m(const PoseGraph& graph,
                                                    const std::vector<std::size_t>& nodes);

}  // namespace psi_slam
