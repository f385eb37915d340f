// SPDX-License-Identifier: BSD-3-Clause
// Keyframe store for loop closing: points and pose of each node, and the finished local maps.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "base/degrees.h"
#include "base/worker_pool.h"
#include "mapping/local_maps/front_end.h"
#include "mapping/loop_closure/local_map_cache.h"
#include "matching/scan_points.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

struct NodeScan {
  std::size_t frame = 0;                     ///< index of the scan in MappingResult::frames
  mrpt::math::TPose2D local_T_robot;         ///< pose of the robot in the front end's frame
  double travelled_m = 0;                    ///< path length from the first node to this one
  std::size_t segment = 0;                   ///< first node of the path segment that holds this node
  std::shared_ptr<const ScanPoints> points;  ///< null if all local maps with this scan are superseded
};

/// A run whose place in the map is unknown: the nodes [begin, end).
struct UnplacedRun {
  std::size_t begin = 0;
  std::size_t end =
      std::numeric_limits<std::size_t>::max();  ///< the largest number while the run still grows
  std::size_t interruption = 0;                 ///< index in MappingResult::interruptions

  bool contains(std::size_t node) const { return begin <= node && node < end; }
};

/// Covariance of a node of the path relative to an earlier one, along the axes of the earlier one.
struct PathCovariance {
  Eigen::Matrix3d drift = Eigen::Matrix3d::Zero();      ///< errors that may repeat along the path
  Eigen::Matrix3d unmatched = Eigen::Matrix3d::Zero();  ///< errors of odometry where no scan matched
};

struct KeyframeStore {
  std::vector<NodeScan> nodes;             ///< nodes in the order of their numbers
  std::vector<PlacedLocalMap> local_maps;  ///< finished local maps, in the order of their ids
  std::shared_ptr<LocalMapCache> cache;    ///< holds the same local maps; null: no local map is ever packed
  /// Runs whose place in the map is unknown, in ascending order. The last one may still grow.
  std::vector<UnplacedRun> unplaced;
  PathCovariance in_segment;          ///< of the newest node relative to the first node of its segment
  std::size_t last_matched_node = 0;  ///< newest node that matched, or that began a run
};

/// Travel that is equivalent to a turn of 1 rad: with the default options, the front end adds about the same
/// number of nodes for both.
inline constexpr double kTravelOfTurn_m = 1.5;

/// Returns the distance between two poses, plus their turn as travel.
double travel_and_turn_m(const mrpt::math::TPose2D& from, const mrpt::math::TPose2D& to);

/// Returns whether the node belongs to a run whose place in the map is unknown.
bool is_unplaced(std::size_t node, const KeyframeStore& keyframes);

/// Returns whether the pose of one node relative to the other is known: both are in the map, or both are in
/// the same run whose place is unknown.
bool are_joined(std::size_t node, std::size_t other, const KeyframeStore& keyframes);

/// Returns an empty store with a cache, which keeps the 48 most recently used local maps unpacked.
KeyframeStore make_keyframe_store();

/// Appends the node of a front-end step. `frame` is the index of the scan in MappingResult::frames.
void remember_node(const FrontEndStep& step, std::size_t frame, KeyframeStore& keyframes);

/// Standard deviations of the errors of the path by the front end, modelled as a random walk.
struct PathNoise {
  /// Share of a step's error, as stated by the front end, that remains in the path. The next scan is matched
  /// with the same local map, which corrects most of the error. The whole error of unmatched steps remains,
  /// until a scan matches a local map that is older than these steps.
  double stated_share = 0.2;
  /// Drift that successive scans share, as standard deviations.
  double sigma_m_per_sqrt_m = 0.002;  ///< of the position, after one metre
  /// Of the heading, after one metre and after a turn of one radian. A wrong scale of the bearings makes the
  /// heading wrong where the robot turns.
  double sigma_rad_per_sqrt_m = radians_from_degrees(0.02L);
  double sigma_rad_per_sqrt_rad = radians_from_degrees(0.06L);
  /// Error of the pose of a single scan, which later scans do not inherit.
  double scan_sigma_m = 0.0075;
  double scan_sigma_rad = radians_from_degrees(0.12L);
};

/// Factor by which the standard deviations of the random walk are increased to search places and to reject
/// loops. Errors that repeat, such as a wrong scale of the bearings, add up along the path and exceed those
/// of a random walk. The factor does not apply where no scan matched, because the whole error is stated
/// there.
inline constexpr double kPathDoubt = 5;

/// Length of a path segment in metres. It is short, so that rigid segments can follow the drift of the path,
/// and long enough that the scans of a segment, which see the same walls, count as one place.
inline constexpr double kSegment_m = 3;

/// Adds the constraint of the newest node, which remember_node() added, from the first node of its path
/// segment. If the node begins a segment, the constraint starts at the first node of the previous segment. A
/// node in no local map begins a run and gets no constraint.
void constrain_to_path(const FrontEndStep& step, const PathNoise& noise, KeyframeStore& keyframes,
                       PoseGraph& graph);

/// Sets the reference of a matched loop, see LoopRecord::reference.
void set_reference(LoopRecord& loop, const KeyframeStore& keyframes);

void remember_local_map(const PlacedLocalMap& finished, KeyframeStore& keyframes);

/// Unpacks local maps if the store has a cache. Call before reading these local maps.
void unpack_local_maps(const KeyframeStore& keyframes, const std::vector<std::size_t>& local_maps,
                       WorkerPool& pool);

/// Returns whether `node` is the first node of a stretch, if the path is divided into stretches of
/// `stretch_m`. Loops are searched only at such nodes. The choice does not depend on loops found before, so a
/// single match does not shift later searches. If `stretch_m` is 0, every node begins a stretch.
bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m);

}  // namespace psi_slam
