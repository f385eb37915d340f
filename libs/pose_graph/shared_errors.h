// SPDX-License-Identifier: BSD-3-Clause
// Model of the errors that constraints of local maps share, for the covariances of poses.
//
// The solver takes all constraints for independent, which places the nodes well but makes their covariances
// several times too small. Three errors are shared:
//  - Successive scans placed in one local map drift together. The error of a constraint of a local map is the
//    sum of the drift since the anchor, and of a small error of the scan itself. A scan in two local maps
//    that overlap is one measurement, not two.
//  - A loop matches a scan with that part of a local map that is near the scan. So it measures the pose of
//    the scan relative to the scans of that part, and inherits their drift relative to the anchor.
//  - Loops between the same two parts of the path repeat one measurement: from successive scans, with
//    overlapping local maps, and in both directions.
// The model divides the path into stretches and gives each stretch a pose of its own. Scans are measured
// relative to their stretch, stretches relative to the stretch before by the drift, and relative to other
// stretches by the loops between the two.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Factor by which the covariances of scans and loops are too small, because the solver takes their errors
/// for independent, see share/doc/covariances.md. Constraints of the kind kKnown get this factor as weight.
inline constexpr double kOverconfidence = 6;

/// Width of the robust kernel of constraints of the kind kKnown, in stated standard deviations.
inline constexpr double kKnownKernelWidth = 3;

/// Returns the factor on the stated information of a constraint of the kind kKnown. It follows from the width
/// of the kernel, which is a number of stated standard deviations.
double weight_of_known(const Constraint& constraint);

/// Sizes of the errors, relative to the stated covariances of the constraints. share/doc/covariances.md says
/// where the defaults come from.
struct SharedErrorOptions {
  double stretch_m = 3;  ///< length of a stretch of path, metres
  /// Share of the variance of a scan's pose in a local map that is the scan's own.
  double scan_share = 0.2;
  /// Share of the variance of a loop that all loops between the same two stretches have in common. Chosen a
  /// little above the correlation of loops of neighbouring scans, which is 0.7.
  double common_loop_share = 0.8;
  /// Factor on the variance of the drift in position. Accounts for the part of the drift that repeats, such
  /// as a wrong scale of odometry along bare corridors, which a random walk lacks.
  double drift_position_factor = 3;
};

/// Returns the graph of the model at the poses of `graph`, for MarginalCovariance. The nodes of `graph` keep
/// their numbers and the root; the stretches follow as further nodes. Constraints of the kinds kOdometry and
/// kRunStart are independent measurements and stay as they are; those of the kind kKnown too, but without
/// weight_of_known(). The constraints agree exactly with the poses, so optimising the graph of the model
/// moves nothing. Throws UserError if the information of a constraint of a local map, or of all loops between
/// two stretches, is singular.
PoseGraph graph_with_shared_errors(const PoseGraph& graph, const SharedErrorOptions& options = {});

/// Returns the covariance of (x, y, theta) of each node relative to the root, in the axes of the map: m^2,
/// m rad, rad^2. Uses the model of shared errors. Zero for the root. Throws UserError like
/// graph_with_shared_errors(), if a node is not linked to the root, or if the constraints do not determine
/// all poses.
std::vector<Eigen::Matrix3d> pose_covariances(const PoseGraph& graph, const SharedErrorOptions& options = {});

/// Returns pose_covariances(graph, options)[node] in less time.
Eigen::Matrix3d pose_covariance(const PoseGraph& graph, std::size_t node,
                                const SharedErrorOptions& options = {});

/// Mean path and number of nodes of the local maps of a graph. Zero without local maps.
struct MeanLocalMap {
  double travel_m = 0;
  double nodes = 0;
};

/// Returns the means over the local maps of a graph.
MeanLocalMap mean_local_map(const PoseGraph& graph);

/// Returns the covariance of the drift of the model from the node before `node` to `node`, in the axes of the
/// map: m^2, m rad, rad^2. Empty if no local map holds `node`, which then begins a run. `mean` may come from
/// an earlier state of the graph, but the drift is empty if that had no local map.
std::optional<Eigen::Matrix3d> drift_covariance(const PoseGraph& graph, std::size_t node,
                                                const MeanLocalMap& mean,
                                                const SharedErrorOptions& options = {});

}  // namespace psi_slam
