// SPDX-License-Identifier: BSD-3-Clause
// The individuals of the memetic search: tiles of the search window, their chromosomes and their fitness.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "matching/pose_code.h"
#include "matching/search_lattice.h"

namespace psi_slam {

/// All shifts of a block at one heading. The sum kernel
/// scores them together for little more than the price of one pose.
struct Tile {
  int theta = 0;  ///< steps from the window's centre
  ShiftBlock block;
};

/// A set of tiles and their codes.
class TileSpace {
 public:
  virtual ~TileSpace() = default;

  virtual std::int64_t size() const = 0;  ///< tiles in all
  virtual int bits() const = 0;
  /// Of any bits() bits: numbers beyond the last stand for their remainder.
  virtual Tile tile(Chromosome chromosome) const = 0;
  /// The one chromosome of its tile: itself, unless it had to be repaired.
  virtual Chromosome repaired(Chromosome chromosome) const = 0;
  /// The tile turned by so many steps; empty where the space holds none.
  virtual std::optional<Chromosome> turned(Chromosome chromosome, int steps) const = 0;
};

/// A whole window, cut into blocks: the bits of the heading, of the column and of the row of the block, each
/// the fewest that hold it, side by side.
class WindowTiles : public TileSpace {
 public:
  static constexpr int kSide = 16;   ///< of a block, in shifts: as wide as the kernel's lanes
  static constexpr int kWhole = 32;  ///< a window of at most so many shifts a side is one block

  /// With `gray`, neighbours along each axis differ in one bit.
  WindowTiles(const SearchWindow& window, bool gray);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int turns() const { return 2 * window_.n_theta + 1; }

  /// Column and row of the block that holds a shift of the window.
  int column_of(int x) const { return (x + window_.n_x) / width_; }
  int row_of(int y) const { return (y + window_.n_y) / height_; }

  Chromosome encode(int theta, int column, int row) const;

  std::int64_t size() const override { return std::int64_t{turns()} * columns_ * rows_; }
  int bits() const override { return theta_bits_ + column_bits_ + row_bits_; }
  Tile tile(Chromosome chromosome) const override;
  Chromosome repaired(Chromosome chromosome) const override;
  std::optional<Chromosome> turned(Chromosome chromosome, int steps) const override;

 private:
  struct Place {
    int theta;
    int column;
    int row;
  };
  Place decode(Chromosome chromosome) const;

  SearchWindow window_;
  bool gray_;
  int width_;  // of a block
  int height_;
  int columns_;
  int rows_;
  int theta_bits_;
  int column_bits_;
  int row_bits_;
};

/// Some coarse cells of a window: the bits of a cell's number, and those of the heading inside it. As in
/// WindowTiles, the fewest bits that hold all: equation 10, whose lengths are at times one more, is
/// PoseCode's.
class CellTiles : public TileSpace {
 public:
  /// Cells are named by their middle heading, and span [theta - turns / 2, theta - turns / 2 + turns). At
  /// least one.
  CellTiles(const SearchWindow& window, std::vector<Tile> cells, int turns, bool gray);

  /// The middle of a cell.
  Chromosome encode(std::size_t cell) const;

  std::int64_t size() const override { return static_cast<std::int64_t>(cells_.size()) * turns_; }
  int bits() const override { return turn_bits_ + cell_bits_; }
  Tile tile(Chromosome chromosome) const override;
  Chromosome repaired(Chromosome chromosome) const override;
  std::optional<Chromosome> turned(Chromosome chromosome, int steps) const override;

 private:
  struct Place {
    std::size_t cell;
    int turn;  // 0 .. turns - 1
  };
  Place decode(Chromosome chromosome) const;
  Chromosome encode(const Place& place) const;

  SearchWindow window_;
  std::vector<Tile> cells_;
  int turns_;
  bool gray_;
  int turn_bits_;
  int cell_bits_;
};

enum class TileLevel {
  kPooled,  ///< an upper bound of the tile's poses, from the first level of the grid's pyramid
  kFinest,  ///< the tile's best pose
};

/// Scores tiles on a lattice.
class TileScorer {
 public:
  explicit TileScorer(const SearchLattice& lattice) : lattice_(lattice) {}

  /// The best sum of the tile and the pose that has it; on the pooled level, the first pose of the block.
  Candidate score(const Tile& tile, TileLevel level);

  /// The best of the 16 x 16 poses around one, -8 .. 7 shifts away, at the same heading, which must be of the
  /// window.
  Candidate best_near(const LatticePose& pose);

  std::int64_t evaluations() const { return evaluations_; }

 private:
  const SearchLattice& lattice_;
  ShiftSums sums_;
  std::int64_t evaluations_ = 0;
};

}  // namespace psi_slam
