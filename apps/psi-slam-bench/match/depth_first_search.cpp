// SPDX-License-Identifier: BSD-3-Clause
#include "match/depth_first_search.h"

#include <algorithm>

namespace psi_slam {
namespace {

/// A square of 2^level x 2^level shifts at one heading, from the shifts of `pose` on.
struct Node {
  std::uint32_t bound = 0;
  LatticePose pose;
};

class DepthFirstSearch {
 public:
  DepthFirstSearch(const SearchLattice& lattice, const MaximumGrids& grids, std::uint32_t min_sum)
      : lattice_(lattice), grids_(grids), least_(min_sum) {}

  DepthFirstOutcome run() {
    constexpr int kTop = MaximumGrids::kLevels - 1;
    const SearchWindow& window = lattice_.window();
    std::vector<Node> roots;
    for (int theta = -window.n_theta; theta <= window.n_theta; ++theta)
      for (int y = -window.n_y; y <= window.n_y; y += 1 << kTop)
        for (int x = -window.n_x; x <= window.n_x; x += 1 << kTop)
          roots.push_back(scored({x, y, theta}, kTop));
    visit(roots, kTop);
    return outcome_;
  }

 private:
  Node scored(const LatticePose& pose, int level) {
    const Cell* cells = lattice_.cells(pose.theta);
    Node node = {0, pose};
    for (std::size_t p = 0; p < lattice_.points(); ++p)
      node.bound += grids_.at(level, cells[p].x + pose.x, cells[p].y + pose.y);
    ++outcome_.evaluations;
    return node;
  }

  // Visits nodes of a level, the most promising first, each with all its descendants.
  void visit(std::vector<Node>& nodes, int level) {
    std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.bound > b.bound; });
    for (const Node& node : nodes) {
      if (node.bound < least_) return;
      if (level == 0) {
        consider({node.bound, node.pose});
        continue;
      }
      std::vector<Node> children = children_of(node, level);
      visit(children, level - 1);
    }
  }

  std::vector<Node> children_of(const Node& node, int level) {
    const int side = 1 << (level - 1);
    std::vector<Node> children;
    for (const int y : {node.pose.y, node.pose.y + side})
      for (const int x : {node.pose.x, node.pose.x + side})
        if (x <= lattice_.window().n_x && y <= lattice_.window().n_y)
          children.push_back(scored({x, y, node.pose.theta}, level - 1));
    return children;
  }

  void consider(const Candidate& candidate) {
    if (outcome_.best && !candidate.better_than(*outcome_.best)) return;
    outcome_.best = candidate;
    least_ = candidate.sum;
  }

  const SearchLattice& lattice_;
  const MaximumGrids& grids_;
  std::uint32_t least_;
  DepthFirstOutcome outcome_;
};

}  // namespace

MaximumGrids::MaximumGrids(const ScoreGrid& grid) {
  const ScoreLevel& finest = grid.finest();
  Level first = {0, finest.width(), finest.height(), {}};
  for (int y = 0; y < first.height; ++y)
    first.cells.insert(first.cells.end(), finest.cell(0, y), finest.cell(0, y) + first.width);
  levels_.push_back(std::move(first));
  while (levels_.size() < kLevels) {
    const Level& finer = levels_.back();
    const int side = finer.margin + 1;  // of the finer level's squares
    Level level = {2 * side - 1, finer.width + side, finer.height + side, {}};
    for (int y = -level.margin; y < level.height - level.margin; ++y)
      for (int x = -level.margin; x < level.width - level.margin; ++x)
        level.cells.push_back(std::max({cell(finer, x, y), cell(finer, x + side, y), cell(finer, x, y + side),
                                        cell(finer, x + side, y + side)}));
    levels_.push_back(std::move(level));
  }
}

std::uint8_t MaximumGrids::cell(const Level& level, int x, int y) {
  const int column = x + level.margin;
  const int row = y + level.margin;
  if (column < 0 || column >= level.width || row < 0 || row >= level.height) return 0;
  return level.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                     static_cast<std::size_t>(column)];
}

std::uint8_t MaximumGrids::at(int level, int x, int y) const {
  return cell(levels_[static_cast<std::size_t>(level)], x, y);
}

DepthFirstOutcome depth_first_search(const SearchLattice& lattice, const MaximumGrids& grids,
                                     std::uint32_t min_sum) {
  return DepthFirstSearch(lattice, grids, min_sum).run();
}

}  // namespace psi_slam
