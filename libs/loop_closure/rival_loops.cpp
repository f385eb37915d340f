// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/rival_loops.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Move = std::array<long, 3>;  // of a node in the map, in units within which moves agree

Move move_by(const Constraint& loop, const PoseGraph& graph) {
  const bool forwards = loop.from < loop.to;
  const TPose2D& earlier = graph.pose(forwards ? loop.from : loop.to);
  const TPose2D& later = graph.pose(forwards ? loop.to : loop.from);
  const TPose2D wanted = compose(earlier, forwards ? loop.from_T_to : inverse(loop.from_T_to));
  return {std::lround((wanted.x - later.x) / kSameMove_m), std::lround((wanted.y - later.y) / kSameMove_m),
          std::lround(mrpt::math::wrapToPi(wanted.phi - later.phi) / kSameTurn_rad)};
}

}  // namespace

std::vector<std::size_t> rival_loops(const PoseGraph& graph, const std::vector<std::size_t>& loops) {
  std::map<Move, std::vector<std::size_t>> by_move;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (!graph.enabled(loops[i])) by_move[move_by(graph.constraint(loops[i]), graph)].push_back(i);
  std::vector<std::size_t> largest;
  for (const auto& [move, here] : by_move) {
    std::vector<std::size_t> agreeing;  // also in the neighbouring cells, because limits may divide a set
    for (const long x : {-1, 0, 1})
      for (const long y : {-1, 0, 1})
        for (const long turn : {-1, 0, 1}) {
          const auto near = by_move.find({move[0] + x, move[1] + y, move[2] + turn});
          if (near != by_move.end())
            agreeing.insert(agreeing.end(), near->second.begin(), near->second.end());
        }
    if (agreeing.size() > largest.size()) largest = std::move(agreeing);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

}  // namespace psi_slam
