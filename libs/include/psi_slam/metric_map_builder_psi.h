// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// MRPT's interface of metric SLAM, mrpt::slam::CMetricMapBuilder, over psi_slam::Mapper:
///
///     psi_slam::CMetricMapBuilderPsi builder;
///     for each step:  builder.processActionObservation(actions, observations);
///     (where a log holds observations one by one:  builder.processObservation(observation);)
///     builder.finish();
///     builder.saveCurrentMapToFile("map.simplemap.gz");
///     builder.saveCurrentEstimationToImage("map.png");
///
/// It takes CObservation2DRangeScan of one laser and odometry, either as actions or as CObservationOdometry:
/// the kind that comes first decides, the other is left unread. All other observations are kept beside their
/// scan in the map but not used. Scans that odometry comes in observations for wait for the odometry behind
/// them, as when a log is read: the estimate is that of the last scan that has its odometry.
///
/// Loops that close move the whole map, and finish() does so once more: poses and maps are those of the call
/// that asks for them. Of the base's options none has any effect but enableMapUpdating, which must stay true:
/// psi-slam does not localise in a fixed map.
///
/// All functions may be called from several threads at once. The map that getCurrentlyBuiltMetricMap() points
/// at changes at the next call of that function, by whichever thread, and at no other time; grid() gives one
/// that never changes.
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

/// Like all of MRPT's classes of that kind, and as other programs will look for it.
class CMetricMapBuilderPsi : public mrpt::slam::CMetricMapBuilder {
 public:
  /// Options of the builder. A Configuration has all of them.
  struct Options {
    LogOptions log;                               ///< the laser, its mount and ranges; ignores every_nth_scan
    GridMapOptions map;                           ///< the grid that is drawn
    std::shared_ptr<const MapperOptions> mapper;  ///< Configuration::mapper_options(); null: the defaults
  };

  /// Throws UserError when an option of the log makes no sense.
  explicit CMetricMapBuilderPsi(const Options& psi_options);
  /// Maps with the default options.
  CMetricMapBuilderPsi();
  ~CMetricMapBuilderPsi() override;

  /// Starts anew with the robot at `x0`, or, where that is null, at the current estimate. Throws UserError
  /// when `initial_map` is not empty: a map made before cannot be gone on with.
  void initialize(const mrpt::maps::CSimpleMap& initial_map = {},
                  const mrpt::poses::CPosePDF* x0 = nullptr) override;

  /// Throws UserError when a scan has no time stamp or no rays, its laser is tilted, or no odometry comes.
  void processActionObservation(mrpt::obs::CActionCollection& action,
                                mrpt::obs::CSensoryFrame& observations) override;
  /// Takes one observation of a log without sensory frames. Throws UserError as processActionObservation().
  void processObservation(const mrpt::obs::CObservation::Ptr& observation);

  /// The last search for loops and the last optimisation. After it the results can be asked for, but nothing
  /// more be processed until initialize(); again has no effect.
  void finish();

  /// The robot at the last scan mapped: a CPose3DPDFGaussian. Its covariance is that of `x0`, of the newest
  /// node given the whole graph, and of a scan in its local map. The first call after a new node or a loop
  /// factorises the whole graph; others cost nothing.
  mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const override;

  /// The nodes of the graph with all that was observed there. Each pose comes with a covariance of (1 mm)^2
  /// and (1 mrad)^2, a stand-in that MRPT can invert.
  void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const override;
  /// Number of nodes of the graph.
  unsigned int getCurrentlyBuiltMapSize() override;

  /// One occupancy grid of all scans at their current poses. It is drawn when asked for and lives as long as
  /// the builder. The first call after a new scan draws all scans of the log anew: ask now and then, not at
  /// every scan.
#if MRPT_VERSION >= 0x292
  const mrpt::maps::CMultiMetricMap& getCurrentlyBuiltMetricMap() const override;
#else
  const mrpt::maps::CMultiMetricMap* getCurrentlyBuiltMetricMap() const override;
#endif

  /// The same grid, to keep: later ones are other objects.
  mrpt::maps::COccupancyGridMap2D::ConstPtr grid() const;

  /// Draws the grid: to PNG with a scale bar; to other formats as MRPT does, by the file's extension. The
  /// choice of the vector format EMF is not offered. Throws SystemFailure when it cannot be written.
#if MRPT_VERSION >= 0x030000
  void saveCurrentEstimationToImage(const std::string& file) override;
#else
  void saveCurrentEstimationToImage(const std::string& file, bool format_emf_bmp = true) override;
#endif

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
