// SPDX-License-Identifier: BSD-3-Clause
#include "matching/tile_scorer.h"

#include <algorithm>

namespace psi_slam {

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
