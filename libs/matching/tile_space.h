// SPDX-License-Identifier: BSD-3-Clause
// The individuals of the memetic search: tiles of the search window, their chromosomes and their fitness.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "matching/pose_code.h"
#include "matching/search_lattice.h"

namespace psi_slam {

/// Angular steps between the headings of coarse searches, and headings of a coarse cell.
inline constexpr int kHeadingStride = 4;

/// All shifts of a block at one heading. The sum kernel scores a tile at little more than the cost of one
/// pose.
struct Tile {
  int theta = 0;  ///< heading, in angular steps from the window's centre
  ShiftBlock block;
};

/// A set of tiles and their chromosomes, in Gray code: codes of neighbours along an axis differ in one bit.
class TileSpace {
 public:
  virtual ~TileSpace() = default;

  virtual std::int64_t size() const = 0;  ///< number of tiles
  virtual int bits() const = 0;
  /// Returns the tile of a chromosome, a number of bits() bits. A number that is too large is replaced by its
  /// remainder (modulus).
  virtual Tile tile(Chromosome chromosome) const = 0;
  /// Returns the unique valid chromosome of the tile that `chromosome` decodes to. It differs from
  /// `chromosome` if that number is too large.
  virtual Chromosome repaired(Chromosome chromosome) const = 0;
  /// Returns the chromosome of the tile turned by `steps` angular steps; empty if that tile is outside the
  /// space.
  virtual std::optional<Chromosome> turned(Chromosome chromosome, int steps) const = 0;
};

/// A whole window, cut into blocks. A chromosome holds the heading, the column and the row of a block, each
/// in as few bits as possible.
class WindowTiles : public TileSpace {
 public:
  static constexpr int kSide = 16;   ///< side of a block in shifts: the lanes of the sum kernel
  static constexpr int kWhole = 32;  ///< a window with at most this many shifts per side is one block

  explicit WindowTiles(const SearchWindow& window);

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
  int width_;  // width of a block, in shifts
  int height_;
  int columns_;
  int rows_;
  int theta_bits_;
  int column_bits_;
  int row_bits_;
};

/// A selection of coarse cells of a window. A chromosome holds the number of a cell and the heading inside
/// it, each in as few bits as possible. PoseCode uses the lengths of equation 10, which are sometimes one bit
/// longer.
class CellTiles : public TileSpace {
 public:
  /// `cells` must not be empty. A cell with the middle heading theta spans the headings [theta -
  /// kHeadingStride / 2, theta + kHeadingStride / 2).
  CellTiles(const SearchWindow& window, std::vector<Tile> cells);

  /// Returns the chromosome of the middle heading of a cell.
  Chromosome encode(std::size_t cell) const;

  std::int64_t size() const override { return static_cast<std::int64_t>(cells_.size()) * kHeadingStride; }
  int bits() const override { return turn_bits_ + cell_bits_; }
  Tile tile(Chromosome chromosome) const override;
  Chromosome repaired(Chromosome chromosome) const override;
  std::optional<Chromosome> turned(Chromosome chromosome, int steps) const override;

 private:
  struct Place {
    std::size_t cell;
    int turn;  // heading inside the cell, 0 .. kHeadingStride - 1
  };
  Place decode(Chromosome chromosome) const;
  Chromosome encode(const Place& place) const;

  SearchWindow window_;
  std::vector<Tile> cells_;
  int turn_bits_;
  int cell_bits_;
};

enum class TileLevel {
  kPooled,  ///< upper bound of the tile's sums, from the first level of the pyramid
  kFinest,  ///< largest sum of the tile's poses
};

/// Scores tiles on a lattice.
class TileScorer {
 public:
  explicit TileScorer(const SearchLattice& lattice) : lattice_(lattice) {}

  /// Returns the best sum of the tile and its pose. On the pooled level, the pose is the first of its 2 x 2
  /// block.
  Candidate score(const Tile& tile, TileLevel level);

  /// Returns the best of the poses at -8 .. 7 shifts from `pose` along x and y, at its heading and inside the
  /// window. The heading must be inside the window.
  Candidate best_near(const LatticePose& pose);

  std::int64_t evaluations() const { return evaluations_; }

 private:
  const SearchLattice& lattice_;
  ShiftSums sums_;
  std::int64_t evaluations_ = 0;
};

}  // namespace psi_slam
