// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// psi_slam::Mapper behind MRPT's interface for metric SLAM, mrpt::slam::CMetricMapBuilder:
///
///     psi_slam::CMetricMapBuilderPsi builder;
///     for each step:  builder.processActionObservation(actions, observations);
///     (for a log of single observations:  builder.processObservation(observation);)
///     builder.finish();
///     builder.saveCurrentMapToFile("map.simplemap.gz");
///     builder.saveCurrentEstimationToImage("map.png");
///
/// Input is CObservation2DRangeScan with odometry, either as actions or as CObservationOdometry. The builder
/// uses the kind of odometry that comes first and ignores the other kind. It stores other observations with
/// the scan that they arrived with, but does not use them. If odometry comes as observations, each scan waits
/// for the next odometry. The pose estimate then belongs to the last scan with odometry.
///
/// Closed loops and finish() change poses of the whole map. Functions return poses and maps as of the time of
/// the call. The only option of the base class with an effect is enableMapUpdating. It must stay true:
/// the builder always maps. It extends an initial map, see initialize(); psi_slam::Localizer finds a robot in
/// a fixed map.
///
/// All functions may be called from several threads at once. The map returned by getCurrentlyBuiltMetricMap()
/// changes only when any thread calls that function again. A map returned by grid() never changes.
#pragma once

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/slam/CMetricMapBuilder.h>
#include <mrpt/version.h>

#include <memory>
#include <string>

#include "psi_slam/grid_map.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

struct MapperOptions;

/// Builds a map with psi_slam::Mapper. The name follows MRPT's own map builders.
class CMetricMapBuilderPsi : public mrpt::slam::CMetricMapBuilder {
 public:
  /// Options of the builder. A Configuration provides all members.
  struct Options {
    /// Options of the laser, its mount and its ranges. every_nth_scan, mask_own_body, imu, slice_z_m,
    /// sweep_time_s and sweep_direction have no effect.
    LogOptions log;
    GridMapOptions map;                           ///< options of the drawn grid map
    std::shared_ptr<const MapperOptions> mapper;  ///< Configuration::mapper_options(); null: the defaults
  };

  /// Creates a builder. Throws UserError if an option of the log is invalid.
  explicit CMetricMapBuilderPsi(const Options& psi_options);
  /// Creates a builder with the default options.
  CMetricMapBuilderPsi();
  ~CMetricMapBuilderPsi() override;

  /// Begins a new map with the robot at `x0`, or at the current estimate if `x0` is null.
  ///
  /// If `initial_map` is not empty, the run extends it without moving it, and poses are in its frame. The
  /// robot is searched near `x0`, within 1 m and 15 degrees, or in the whole initial map if `x0` is null.
  /// Until it is found there, poses begin at the current estimate. While mapping, the robot's pose follows
  /// the initial map, and grids show the run alone. After finish(), grids show the initial map, brought up to
  /// date: walls that the run sees to be gone are removed, and new ones are added. If the run does not fit
  /// the initial map, finish() logs a warning, and the map contains the run alone. Throws UserError if
  /// `initial_map` has frames but no 2D range scan with returns.
  void initialize(const mrpt::maps::CSimpleMap& initial_map = {},
                  const mrpt::poses::CPosePDF* x0 = nullptr) override;

  /// Maps the scans. Throws UserError if a scan has no time stamp or no rays, its laser is tilted, if
  /// odometry is missing, or if enableMapUpdating is false. Throws std::logic_error after finish().
  void processActionObservation(mrpt::obs::CActionCollection& action,
                                mrpt::obs::CSensoryFrame& observations) override;
  /// Maps a single observation. Throws like processActionObservation().
  void processObservation(const mrpt::obs::CObservation::Ptr& observation);

  /// Finishes the map: final loop search, optimisation and joint refinement of all scans. Afterwards only
  /// results are available, until initialize(). Further calls have no effect.
  void finish();

  /// Pose of the robot at the last mapped scan, a CPose3DPDFGaussian. Before the first scan, the pose `x0` of
  /// initialize(). The covariance combines those of `x0`, of the newest node in the graph, and of a scan in
  /// its local map, and accounts for the errors that constraints of one local map share. Most calls
  /// carry the last covariance along by the motion. A call factorises a model of the whole graph only if the
  /// graph has grown by 0.5 % with new loops or by 2 % without, or after finish().
  mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const override;

  /// Stores the nodes of the graph with their observations in `out_map`. Every pose gets a placeholder
  /// covariance that MRPT can invert: 1 mm and 1 mrad, squared.
  void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const override;
  /// Number of nodes of the graph.
  unsigned int getCurrentlyBuiltMapSize() override;

  /// Returns an occupancy grid of all scans. The reference is valid as long as the builder. Before finish(),
  /// a call draws the new scans and at most eight earlier scans whose poses have changed by more than 2.5 cm
  /// or 2.5 mrad, so this function may be called at every scan. A correction of the whole map is thus worked
  /// off over several calls, and a standstill counts with all its scans. The first
  /// call after finish() draws the whole grid.
#if MRPT_VERSION >= 0x292  // 2.9.2; the macro of later versions, such as 0x20e07 of 2.14.7, is larger
  const mrpt::maps::CMultiMetricMap& getCurrentlyBuiltMetricMap() const override;
#else
  const mrpt::maps::CMultiMetricMap* getCurrentlyBuiltMetricMap() const override;
#endif

  /// Returns the grid of getCurrentlyBuiltMetricMap() as an object that never changes.
  mrpt::maps::COccupancyGridMap2D::ConstPtr grid() const;

  /// Writes the grid as PNG with a scale bar, or in another format by MRPT, chosen by the file's extension.
  /// Ignores `format_emf_bmp`. Throws SystemFailure if writing fails.
#if MRPT_VERSION >= 0x030000
  void saveCurrentEstimationToImage(const std::string& file) override;
#else
  void saveCurrentEstimationToImage(const std::string& file, bool format_emf_bmp = true) override;
#endif

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
