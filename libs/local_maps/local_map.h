// SPDX-License-Identifier: BSD-3-Clause
// A local map: MRPT's occupancy grid over a bounded run of scans, and the score grid that scans are matched
// with.
//
// Its frame is the pose of its first node, the anchor. While it is active, scans are inserted and the score
// grid follows; once finished it never changes again: its pyramid is built and the occupancy grid is given
// back. A finished one that is not needed for a while can be packed: it then takes a small part of the
// memory, and unpacked it is what it was.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "compression/packed_bytes.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct LocalMapOptions {
  double resolution_m = 0.05;
  double hit_probability = 0.65;   ///< of a cell being occupied, given that a scan point fell into it
  double miss_probability = 0.48;  ///< of a cell being occupied, given that a beam passed through it
  double smoothing_sigma_m =
      0.03;  ///< of the Gaussian that turns occupancy into scores: range noise and cell size
  double max_insert_range_m = 40.0;  ///< beams are cut there: beyond, nothing is drawn
};

/// One scan ready to be drawn: beams from `origin` to each of `ends`, in the local map's frame, metres.
struct Beams {
  mrpt::math::TPoint2D origin;
  std::vector<mrpt::math::TPoint2D> ends;
  std::vector<bool> hits;  ///< false: the beam was cut at the largest range, there is nothing at its end
};

class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options);

  /// A finished one of a grid that was drawn elsewhere, in the grid's frame and of its resolution.
  LocalMap(const LocalMapOptions& options, const mrpt::maps::COccupancyGridMap2D& drawn);

  /// Draws a scan: cells at beam ends become more occupied, cells on the way there less, each at most once a
  /// scan and ends before ways. Must not be called after finish().
  void insert(const Beams& beams) { insert(std::vector<Beams>{beams}); }

  /// Scans of several lasers at once, each with the origin of its own, are drawn as one: no beam of one laser
  /// wipes out what another saw at that very time.
  void insert(const std::vector<Beams>& scans);

  /// What was inserted so far; none once finished.
  const std::optional<mrpt::maps::COccupancyGridMap2D>& occupancy() const { return grid_; }

  /// The score grid of all that was inserted so far.
  const ScoreGrid& scores();
  const ScoreGrid& scores() const { return scores_; }  ///< of a finished map

  /// No more scans: builds the pyramid and frees the occupancy grid.
  void finish();
  bool finished() const { return finished_; }

  /// Packs a finished map, or unpacks it; nothing happens where it is so already. A packed map has no scores
  /// and cannot be compared with (std::logic_error): unpack it first. Not to be called while another thread
  /// looks at the map.
  void pack();
  void unpack();
  bool packed() const { return packed_; }

  /// How well points drawn at a pose agree with what the map saw there.
  struct Agreement {
    std::size_t observed = 0;  ///< points in space that the map has observed, free or occupied
    std::size_t hits = 0;      ///< of those, points on or beside something occupied
    double share() const {
      return observed == 0 ? 0 : static_cast<double>(hits) / static_cast<double>(observed);
    }
  };
  /// Of a finished map, or of an active one whose score grid is up to date.
  Agreement agreement(const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) const;

  std::size_t memory_bytes() const;

 private:
  struct Region {  // of cells, empty when x_end <= x
    int x = 0;
    int y = 0;
    int x_end = 0;
    int y_end = 0;
  };
  struct Way {  // from cell to cell
    int from_x = 0;
    int from_y = 0;
    int to_x = 0;
    int to_y = 0;
  };
  void grow_to_hold(const std::vector<Beams>& scans);
  void add_to_dirty(const Region& region);
  Region observed_region() const;
  bool observed(int x, int y) const;
  void draw_hits(const Beams& beams, std::vector<Way>& ways);
  void draw_hit(int x, int y);
  void draw_way(int x0, int y0, int x1, int y1);

  LocalMapOptions options_;
  /// Until it is finished. MRPT's grid keeps its memory when it is made smaller, so that it must go
  /// altogether.
  std::optional<mrpt::maps::COccupancyGridMap2D> grid_;
  std::vector<std::uint16_t> last_scan_;  ///< for each cell, the scan that last touched it
  std::uint16_t scan_ = 0;
  Region dirty_;
  ScoreGrid scores_;
  std::vector<std::uint8_t>
      observed_;               ///< of a finished map: of each 2 x 2 cells, 1 when any was observed, else 0
  PackedBytes packed_scores_;  ///< both made when it is packed first, then kept
  PackedBytes packed_observed_;
  bool packed_ = false;
  bool scores_fit_ = false;  ///< the score grid has the occupancy grid's size
  bool finished_ = false;
};

}  // namespace psi_slam
