// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/agreeing_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using MoveCell = std::array<long, 3>;  // x, y and turn of a move

// A set spans three cells along each axis.
constexpr double kMoveCell_m = 0.5;
constexpr long kTurnCells = 64;  // of a whole turn

/// Returns the cell of the move of the loop's later node.
MoveCell cell_of(const Constraint& loop, const PoseGraph& graph) {
  const bool forwards = loop.from < loop.to;
  const TPose2D& earlier = graph.pose(forwards ? loop.from : loop.to);
  const TPose2D& later = graph.pose(forwards ? loop.to : loop.from);
  const TPose2D wanted = compose(earlier, forwards ? loop.from_T_to : inverse(loop.from_T_to));
  return {std::lround((wanted.x - later.x) / kMoveCell_m), std::lround((wanted.y - later.y) / kMoveCell_m),
          std::lround((wanted.phi - later.phi) / (2 * M_PI) * kTurnCells)};
}

long wrapped(long turn) {
  return ((turn % kTurnCells) + kTurnCells) % kTurnCells;
}

bool nearly_fits(const MoveCell& cell) {
  return std::abs(cell[0]) <= 1 && std::abs(cell[1]) <= 1 && wrapped(cell[2] + 1) <= 2;
}

}  // namespace

std::vector<std::size_t> agreeing_loops(const PoseGraph& graph, const std::vector<std::size_t>& loops) {
  std::map<MoveCell, std::vector<std::size_t>> in_cell;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (graph.enabled(loops[i])) continue;
    const MoveCell cell = cell_of(graph.constraint(loops[i]), graph);
    if (!nearly_fits(cell)) in_cell[{cell[0], cell[1], wrapped(cell[2])}].push_back(i);
  }
  std::vector<std::size_t> largest;
  for (const auto& [cell, here] : in_cell) {
    std::vector<std::size_t> agreeing;
    for (const long x : {-1, 0, 1})
      for (const long y : {-1, 0, 1})
        for (const long turn : {-1, 0, 1}) {
          const auto near = in_cell.find({cell[0] + x, cell[1] + y, wrapped(cell[2] + turn)});
          if (near != in_cell.end())
            agreeing.insert(agreeing.end(), near->second.begin(), near->second.end());
        }
    if (agreeing.size() > largest.size()) largest = std::move(agreeing);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

}  // namespace psi_slam
