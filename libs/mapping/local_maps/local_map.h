// SPDX-License-Identifier: BSD-3-Clause
// A local map: MRPT's occupancy grid of a limited number of scans, and the score grid for matching with them.
//
// Its frame is the pose of its first node, the anchor. While the map is active, scans are inserted and the
// score grid is updated. A finished map never changes: finish() builds its pyramid and frees the occupancy
// grid. A finished map can be packed without loss, which frees most of its memory until it is unpacked.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/compression/packed_bytes.h"
#include "logs/frames/digital_line.h"
#include "mapping/local_maps/score_painter.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct LocalMapOptions {
  double resolution_m = 0.05;
  double hit_probability = 0.65;      ///< occupancy probability of a cell, given a scan point in it
  double miss_probability = 0.48;     ///< occupancy probability of a cell, given a beam through it
  double smoothing_sigma_m = 0.03;    ///< standard deviation of the Gaussian that blurs the scores
  double max_insert_range_m = 200.0;  ///< longer beams are cut at this range; usual 2D lidars stay below it
};

/// One scan for drawing: beams from `origin` to each of `ends`, in the local map's frame, metres.
struct Beams {
  mrpt::math::TPoint2D origin;
  std::vector<mrpt::math::TPoint2D> ends;
  std::vector<bool> hits;  ///< for each end, true: a return; false: the beam was cut at the largest range
  /// For each end, whether it lies on one surface with the end before it; for the first end, with the last.
  /// Empty: false for all ends.
  std::vector<bool> joined{};
};

class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options);

  /// Makes a finished map from an occupancy grid. Takes over the grid's frame and resolution.
  LocalMap(const LocalMapOptions& options, const mrpt::maps::COccupancyGridMap2D& drawn);

  /// Draws a scan. Cells at beam ends, and between ends on one surface, become more occupied. Cells along the
  /// beams become less occupied. A scan changes each cell at most once; surfaces take precedence over beams.
  /// Leaves out a scan for which the grid would need more than 10^8 cells, because such a scan is far from
  /// the others. Must not be called after finish().
  void insert(const Beams& beams) { insert(std::vector<Beams>{beams}); }

  /// Draws simultaneous scans of several lasers as one scan, so that no beam of one laser erases the beam
  /// ends of another.
  void insert(const std::vector<Beams>& scans);

  /// Occupancy grid of all inserted scans; empty for a finished map.
  const std::optional<mrpt::maps::COccupancyGridMap2D>& occupancy() const { return grid_; }

  /// Returns the score grid, updated with all inserted scans. It lacks its pyramid until the map is finished.
  const ScoreGrid& scores();
  const ScoreGrid& scores() const { return scores_; }  ///< score grid without update, for a finished map

  /// Ends the insertion of scans: builds the pyramid and frees the occupancy grid.
  void finish();
  bool finished() const { return finished_; }

  /// Packs or unpacks a finished map. Does nothing if the map is unfinished or already in that state. A
  /// packed map has no scores, and agreement() throws std::logic_error. Not thread-safe.
  void pack();
  void unpack();
  bool packed() const { return packed_; }

  /// Agreement of a scan at a pose with the cells that the map observed.
  struct Agreement {
    std::size_t observed = 0;  ///< points in cells that the map has observed, free or occupied
    std::size_t hits = 0;      ///< observed points on or beside an occupied cell
    double share() const {
      return observed == 0 ? 0 : static_cast<double>(hits) / static_cast<double>(observed);
    }
  };
  /// Counts the points of a scan that agree with the map. The map must be finished, or scores() must have
  /// been called after the last insert().
  Agreement agreement(const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) const;

  std::size_t memory_bytes() const;

 private:
  struct Region {  // cells [x, x_end) x [y, y_end); empty if x_end <= x
    int x = 0;
    int y = 0;
    int x_end = 0;
    int y_end = 0;
  };
  struct Limits {  // of the grid, metres
    double x_min = 0;
    double x_max = 0;
    double y_min = 0;
    double y_max = 0;
    bool operator==(const Limits& other) const {
      return x_min == other.x_min && x_max == other.x_max && y_min == other.y_min && y_max == other.y_max;
    }
  };
  std::vector<const Beams*> grow_to_hold(const std::vector<Beams>& scans);
  std::optional<Limits> limits_with(const Beams& beams, Limits limits) const;
  void follow_size();
  void mark_dirty(std::size_t cell);
  void begin_scores();
  void paint_dirty_tiles();
  Region observed_region() const;
  void draw_hits(const Beams& beams, std::vector<DigitalLine>& ways);
  void draw_hit(int x, int y);
  void draw_surface(int x0, int y0, int x1, int y1);
  void draw_way(const DigitalLine& way);

  LocalMapOptions options_;
  /// Empty for a finished map: the grid is destroyed, because MRPT's grid keeps its memory when it shrinks.
  std::optional<mrpt::maps::COccupancyGridMap2D> grid_;
  std::vector<std::uint16_t> last_scan_;  ///< for each cell, the number of the last scan that changed it
  std::uint16_t scan_ = 0;
  LineFan ways_;                         ///< scratch memory of insert()
  std::optional<ScorePainter> painter_;  ///< empty for a finished map
  /// For each tile of kTileSide x kTileSide cells of the occupancy grid, row by row, 1 if the evidence of a
  /// cell has changed since the scores were painted.
  std::vector<std::uint8_t> dirty_tiles_;
  int tile_columns_ = 0;
  ScoreGrid scores_;
  std::vector<std::uint8_t> observed_;  ///< 1 for each 2 x 2 block with an observed cell; finished maps only
  PackedBytes packed_scores_;           ///< filled by the first pack(), like packed_observed_
  PackedBytes packed_observed_;
  bool packed_ = false;
  bool scores_fit_ = false;  ///< whether the score grid is as large as the occupancy grid
  bool finished_ = false;
};

/// A local map with its place on the robot's path. Front end and loop closing share it.
struct PlacedLocalMap {
  std::size_t id = 0;               ///< number of the local map, from 0 in the order of creation
  std::size_t anchor = 0;           ///< first node; its pose is the frame of the map
  mrpt::math::TPose2D local_T_map;  ///< the anchor's pose in the front end's frame
  std::size_t first_node = 0;       ///< the map holds the scans of the nodes [first_node, last_node]
  std::size_t last_node = 0;
  double travelled_m = 0;  ///< path length of the robot while the map was active
  /// Covariance of the robot's pose in this map while the map is active, along the map's axes: m^2, m rad,
  /// rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::shared_ptr<LocalMap> map;  ///< null if the local map is superseded
  bool is_superseded = false;     ///< whether later passes see all that it shows, see superseded_maps.h
};

}  // namespace psi_slam
