// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/score_painter.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

// Occupancy probability that counts as full evidence. A single hit reaches it, so logs with few scans can be
// matched.
constexpr double kCertain = 0.65;

// Number of cells that none_occupied() reads.
constexpr int kBlock = 8;

// Returns whether none of kBlock cells is occupied. MRPT: negative log-odds are occupied.
bool none_occupied(const Grid::cellType* cells) {
  static_assert(sizeof(Grid::cellType) == 1);
  std::uint64_t bits = 0;
  std::memcpy(&bits, cells, kBlock);
  return (bits & 0x8080808080808080U) == 0;
}

}  // namespace

ScorePainter::ScorePainter(double sigma_m, double resolution_m)
    : reach_(std::max(1, static_cast<int>(std::ceil(2.5 * sigma_m / resolution_m)))) {
  const double sigma_cells = sigma_m / resolution_m;
  const auto gauss = [&](int d) { return portable::exp(-0.5 * d * d / (sigma_cells * sigma_cells)); };
  double line = 0;
  for (int d = -reach_; d <= reach_; ++d) line += gauss(d);
  for (int y = -reach_; y <= reach_; ++y)
    for (int x = -reach_; x <= reach_; ++x)
      kernel_.push_back(static_cast<std::uint16_t>(std::lround(256 * gauss(x) * gauss(y) / line)));
  // NOLINTNEXTLINE(bugprone-signed-char-misuse): the value of a cell is a signed number, not a character
  for (int raw = Grid::OCCGRID_CELLTYPE_MIN; raw <= Grid::OCCGRID_CELLTYPE_MAX; ++raw) {
    const double occupied = 1 - static_cast<double>(Grid::l2p(static_cast<Grid::cellType>(raw)));
    const double evidence = std::clamp((occupied - 0.5) / (kCertain - 0.5), 0.0, 1.0);
    evidence_[static_cast<std::uint8_t>(raw)] = static_cast<std::uint8_t>(std::lround(255 * evidence));
  }
}

void ScorePainter::paint(const Grid& grid, int x, int y, int x_end, int y_end, ScoreLevel& scores) {
  const int width = x_end - x;
  const int height = y_end - y;
  if (width <= 0 || height <= 0) return;
  // A margin of 2 `reach_` cells around the region avoids bounds checks while the evidence is spread.
  const int row = width + 4 * reach_;
  sums_.assign(static_cast<std::size_t>(row) * static_cast<std::size_t>(height + 4 * reach_), 0);
  const int side = 2 * reach_ + 1;
  const int from_x = std::max(0, x - reach_);
  const int to_x = std::min(static_cast<int>(grid.getSizeX()), x_end + reach_);
  const int from_y = std::max(0, y - reach_);
  const int to_y = std::min(static_cast<int>(grid.getSizeY()), y_end + reach_);
  for (int cy = from_y; cy < to_y; ++cy) {
    const Grid::cellType* cells = grid.getRow(cy);
    for (int cx = from_x; cx < to_x; ++cx) {
      while (cx + kBlock <= to_x && none_occupied(cells + cx)) cx += kBlock;
      if (cx == to_x) break;
      if (cells[cx] >= 0) continue;  // not occupied
      const std::uint16_t evidence = this->evidence(cells[cx]);
      std::uint16_t* target =
          sums_.data() + static_cast<std::ptrdiff_t>(cy - y + reach_) * row + (cx - x + reach_);
      const std::uint16_t* weight = kernel_.data();
      for (int j = 0; j < side; ++j, target += row, weight += side)
        for (int i = 0; i < side; ++i)
          target[i] = static_cast<std::uint16_t>(target[i] + ((evidence * weight[i]) >> 8));
    }
  }
  for (int j = 0; j < height; ++j) {
    const std::uint16_t* sum = sums_.data() + static_cast<std::ptrdiff_t>(j + 2 * reach_) * row + 2 * reach_;
    std::uint8_t* score = scores.cell(x, y + j);
    for (int i = 0; i < width; ++i)
      score[i] = static_cast<std::uint8_t>(std::min<std::uint16_t>(sum[i], 255));
  }
}

}  // namespace psi_slam
