// SPDX-License-Identifier: BSD-3-Clause
#include "matching/tile_space.h"

#include <algorithm>
#include <utility>

namespace psi_slam {
namespace {

// Returns the smallest number of bits that hold 0 .. count - 1.
int bits_for(std::size_t count) {
  int bits = 0;
  while ((std::uint64_t{1} << bits) < count) ++bits;
  return bits;
}

Chromosome from_gray(Chromosome gray) {
  for (int shift = 1; shift < 64; shift *= 2) gray ^= gray >> shift;
  return gray;
}

Chromosome to_gray(std::size_t number) {
  return number ^ (number >> 1);
}

// Decodes the number in the bits [first, first + bits). Takes it modulo `count`.
int number_in(Chromosome chromosome, int first, int bits, std::size_t count) {
  const Chromosome code = (chromosome >> first) & ((Chromosome{1} << bits) - 1);
  return static_cast<int>(from_gray(code) % count);
}

int ceil_divide(int a, int b) {
  return (a + b - 1) / b;
}

}  // namespace

WindowTiles::WindowTiles(const SearchWindow& window) : window_(window) {
  const int width = 2 * window.n_x + 1;
  const int height = 2 * window.n_y + 1;
  const bool one_block = width <= kWhole && height <= kWhole;
  width_ = one_block ? width : kSide;
  height_ = one_block ? height : kSide;
  columns_ = ceil_divide(width, width_);
  rows_ = ceil_divide(height, height_);
  theta_bits_ = bits_for(static_cast<std::size_t>(turns()));
  column_bits_ = bits_for(static_cast<std::size_t>(columns_));
  row_bits_ = bits_for(static_cast<std::size_t>(rows_));
}

Chromosome WindowTiles::encode(int theta, int column, int row) const {
  return to_gray(static_cast<std::size_t>(theta + window_.n_theta)) |
         (to_gray(static_cast<std::size_t>(column)) << theta_bits_) |
         (to_gray(static_cast<std::size_t>(row)) << (theta_bits_ + column_bits_));
}

WindowTiles::Place WindowTiles::decode(Chromosome chromosome) const {
  const auto number = [&](int first, int bits, int count) {
    return number_in(chromosome, first, bits, static_cast<std::size_t>(count));
  };
  return {number(0, theta_bits_, turns()) - window_.n_theta, number(theta_bits_, column_bits_, columns_),
          number(theta_bits_ + column_bits_, row_bits_, rows_)};
}

Tile WindowTiles::tile(Chromosome chromosome) const {
  const Place place = decode(chromosome);
  const int x = place.column * width_;
  const int y = place.row * height_;
  return {place.theta,
          {{x - window_.n_x, y - window_.n_y},
           std::min(width_, 2 * window_.n_x + 1 - x),
           std::min(height_, 2 * window_.n_y + 1 - y)}};
}

Chromosome WindowTiles::repaired(Chromosome chromosome) const {
  const Place place = decode(chromosome);
  return encode(place.theta, place.column, place.row);
}

std::optional<Chromosome> WindowTiles::turned(Chromosome chromosome, int steps) const {
  const Place place = decode(chromosome);
  const int theta = place.theta + steps;
  if (theta < -window_.n_theta || theta > window_.n_theta) return std::nullopt;
  return encode(theta, place.column, place.row);
}

CellTiles::CellTiles(const SearchWindow& window, std::vector<Tile> cells)
    : window_(window),
      cells_(std::move(cells)),
      turn_bits_(bits_for(kHeadingStride)),
      cell_bits_(bits_for(cells_.size())) {}

Chromosome CellTiles::encode(std::size_t cell) const {
  return encode(Place{cell, kHeadingStride / 2});
}

Chromosome CellTiles::encode(const Place& place) const {
  return to_gray(static_cast<std::size_t>(place.turn)) | (to_gray(place.cell) << turn_bits_);
}

// Decodes a cell and a heading. Limits the heading to the window.
CellTiles::Place CellTiles::decode(Chromosome chromosome) const {
  const auto cell = static_cast<std::size_t>(number_in(chromosome, turn_bits_, cell_bits_, cells_.size()));
  const int turn = number_in(chromosome, 0, turn_bits_, kHeadingStride);
  const int first = cells_[cell].theta - kHeadingStride / 2;
  return {cell, std::clamp(first + turn, -window_.n_theta, window_.n_theta) - first};
}

Tile CellTiles::tile(Chromosome chromosome) const {
  const Place place = decode(chromosome);
  Tile tile = cells_[place.cell];
  tile.theta += place.turn - kHeadingStride / 2;
  return tile;
}

Chromosome CellTiles::repaired(Chromosome chromosome) const {
  return encode(decode(chromosome));
}

std::optional<Chromosome> CellTiles::turned(Chromosome chromosome, int steps) const {
  const Place place = decode(chromosome);
  const int turn = place.turn + steps;
  const int theta = cells_[place.cell].theta + turn - kHeadingStride / 2;
  if (turn < 0 || turn >= kHeadingStride || std::abs(theta) > window_.n_theta) return std::nullopt;
  return encode(Place{place.cell, turn});
}

Candidate TileScorer::score(const Tile& tile, TileLevel level) {
  const ScoreGrid& grid = lattice_.grid();
  const ScoreLevel& scores = level == TileLevel::kPooled ? grid.pyramid(0) : grid.finest();
  const int stride = scores.stride_cells();
  const int width = (tile.block.width + stride - 1) / stride;
  const int height = (tile.block.height + stride - 1) / stride;
  sums_.compute(scores, lattice_.cells(tile.theta), lattice_.points(), tile.block.first, width, height);
  evaluations_ += static_cast<std::int64_t>(width) * height;
  Candidate best = {0, {tile.block.first.x, tile.block.first.y, tile.theta}};
  for (int y = 0; y < height; ++y) {
    const std::uint32_t* row = sums_.row(y);
    for (int x = 0; x < width; ++x) {
      if (row[x] < best.sum) continue;
      const Candidate candidate = {
          row[x], {tile.block.first.x + x * stride, tile.block.first.y + y * stride, tile.theta}};
      if (candidate.better_than(best)) best = candidate;
    }
  }
  return best;
}

Candidate TileScorer::best_near(const LatticePose& pose) {
  constexpr int kNear = 8;
  const SearchWindow& window = lattice_.window();
  const int x = std::max(pose.x - kNear, -window.n_x);
  const int y = std::max(pose.y - kNear, -window.n_y);
  return score(
      {pose.theta,
       {{x, y}, std::min(pose.x + kNear, window.n_x + 1) - x, std::min(pose.y + kNear, window.n_y + 1) - y}},
      TileLevel::kFinest);
}

}  // namespace psi_slam
