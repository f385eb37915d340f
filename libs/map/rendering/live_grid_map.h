// SPDX-License-Identifier: BSD-3-Clause
// The grid map of a robot that drives. Draws new scans, and draws scans again whose poses have changed since,
// for instance after a loop, instead of drawing the whole map. Each call does a bounded amount of work
// besides the new scans, so a correction of the whole map is worked off over several calls.
//
// The map equals that of draw_grid_map() with keep_moving and min_beams = 1 for the poses at which the scans
// are drawn, if the robot never stands still for ten seconds and no cell counts 10,000 scans. Here every scan
// that has ranges counts once, also in a standstill, and counts never saturate.
#pragma once

#include <mrpt/math/TBoundingBox.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <vector>

#include "logs/frames/pose_tolerance.h"
#include "map/rendering/frame_cells.h"
#include "map/rendering/grid_tiles.h"
#include "psi_slam/frame.h"
#include "psi_slam/grid_map.h"

namespace psi_slam {

struct LiveGridOptions {
  GridMapOptions map;
  /// A scan is drawn again if its pose has changed by more since it was drawn. The default is half a cell of
  /// the usual size, for the position and for the end of a beam of ten metres.
  PoseTolerance moved{0.025, 0.0025};
  std::size_t redrawn_scans = 8;    ///< largest number of earlier scans that a call draws again
  std::size_t checked_scans = 500;  ///< largest number of earlier scans whose poses a call compares
};

class LiveGridMap {
 public:
  /// Returns the pose of the robot in the map at a frame.
  using Poses = std::function<mrpt::math::TPose2D(std::size_t frame)>;
  /// Returns whether other work waits.
  using Hurry = std::function<bool()>;

  /// Throws std::invalid_argument if an option is out of range.
  explicit LiveGridMap(const LiveGridOptions& options);

  /// Draws the frames that `log` has more than at the last call. Then compares the poses of earlier frames in
  /// turn, from where the last call ended, and draws those again that have moved: one of them at least, and
  /// no more once `hurry` is true. The mapper may change or discard the ranges of the last frames between the
  /// calls. Earlier frames that lose their ranges stay in the map, where they were drawn last, until they
  /// outnumber the frames with ranges; then the map is drawn anew, without them. Throws as draw_grid_map()
  /// does.
  void update(const std::vector<Frame>& log, const Poses& map_T_robot, const Hurry& hurry = {});

  /// Whether all frames of the last call were drawn close to their poses in that and earlier calls.
  bool is_settled() const { return unmoved_ >= drawn_.size(); }
  /// Whether all frames are drawn, though possibly at earlier poses. False while a map that became too large
  /// is drawn with coarser cells.
  bool is_complete() const { return missing_ == 0; }

  /// Pose at which a frame was last drawn.
  const mrpt::math::TPose2D& drawn_pose(std::size_t frame) const { return drawn_.at(frame).map_T_robot; }
  /// Number of drawings and removals of scans so far.
  std::size_t work() const { return work_; }

  /// Returns the map as it is drawn now.
  GridSnapshot snapshot();

 private:
  struct Drawn {
    mrpt::math::TPose2D map_T_robot;
    /// Bounds of all rays, metres.
    mrpt::math::TBoundingBox bounds = mrpt::math::TBoundingBox::PlusMinusInfinity();
    bool has_ranges = false;
    bool is_drawn = false;  ///< false until the frame is drawn with coarser cells
  };

  void draw(const Frame& frame, const mrpt::math::TPose2D& map_T_robot, std::size_t index);
  void take_out(const Frame& frame, Drawn& drawn);
  void follow_changes(const std::vector<Frame>& log);
  void draw_moved(const std::vector<Frame>& log, const Poses& map_T_robot, const Hurry& hurry);
  const Frame& as_drawn(std::size_t frame, const std::vector<Frame>& log) const;
  void use_coarser_cells_if_needed();
  void start_again(double resolution_m);
  mrpt::math::TBoundingBox bounds();

  LiveGridOptions options_;
  FrameCellFinder finder_;
  GridTiles tiles_;
  std::vector<Drawn> drawn_;     ///< one entry for each frame
  std::deque<Frame> recent_;     ///< copies of the last frames, as they were drawn
  std::size_t next_check_ = 0;   ///< frame whose pose is compared next
  std::size_t unmoved_ = 0;      ///< number of frames in succession that had not moved
  std::size_t missing_ = 0;      ///< number of frames that are not drawn
  std::size_t with_ranges_ = 0;  ///< number of drawn frames that have ranges
  std::size_t superseded_ = 0;   ///< number of drawn frames that have lost their ranges since
  std::size_t work_ = 0;
  double resolution_m_;
  /// Bounds of some successive frames, so that a frame that moves costs the same in every map.
  struct Bounds {
    mrpt::math::TBoundingBox box = mrpt::math::TBoundingBox::PlusMinusInfinity();
    bool may_shrink = false;
  };
  std::vector<Bounds> bounds_;
};

}  // namespace psi_slam
