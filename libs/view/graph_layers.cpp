// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "view/dots.h"
#include "view/layers.h"
#include "view/lines.h"
#include "view/loop_legend.h"
#include "view/palette.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::opengl::CSetOfLines;

constexpr std::uint8_t kFaint = 45;
// What lies below is to be seen, too: the more loops, the paler each.
constexpr double kClear = 140;
constexpr double kPalest = 50;
constexpr double kClearLoops = 100;

// They cover the map long before all are drawn, and what is drawn costs time at every frame of the window.
constexpr std::size_t kMostLoopsOfFinalSearch = 3000;

std::size_t final_search_loops(const ReplaySnapshot& snapshot) {
  return static_cast<std::size_t>(std::count_if(snapshot.loops->begin(), snapshot.loops->end(),
                                                [](const LoopRecord& loop) { return loop.in_final_search; }));
}

std::uint8_t clear_alpha(const ReplaySnapshot& snapshot) {
  const auto loops = std::count_if(
      snapshot.loops->begin(), snapshot.loops->end(),
      [](const LoopRecord& loop) { return loop.verdict == LoopVerdict::kAccepted && !loop.in_final_search; });
  const double crowd = std::max(1.0, static_cast<double>(loops) / kClearLoops);
  return static_cast<std::uint8_t>(std::max(kPalest, kClear / std::sqrt(crowd)));
}

}  // namespace

void draw_nodes(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  layer.clear();
  std::vector<mrpt::math::TPoint3Df> points;
  for (const TPose2D& node : *snapshot.map_T_node) points.push_back(raised(node, height_m::kNodes));
  layer.insert(dots_of(points, palette::kNode, 4));
}

void draw_constraints(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  layer.clear();
  auto lines = lines_of(palette::kConstraint, 1);
  const std::vector<TPose2D>& nodes = *snapshot.map_T_node;
  for (std::size_t i = 0; i < snapshot.local_maps.size(); ++i) {
    const LocalMapRecord& map = snapshot.local_maps[i];
    for (std::size_t node = map.first_node; node <= map.last_node && node < nodes.size(); ++node)
      if (node != map.anchor) join(*lines, nodes[map.anchor], nodes[node], height_m::kConstraints);
  }
  layer.insert(lines);
}

void draw_loops(SceneLayer& layer, const ReplaySnapshot& snapshot, const LoopStyle& style) {
  layer.clear();
  using Key = std::tuple<bool, std::uint8_t, std::uint8_t, std::uint8_t>;
  std::map<Key, CSetOfLines::Ptr> by_colour;
  const std::size_t stride = final_search_loops(snapshot) / kMostLoopsOfFinalSearch + 1;
  const std::uint8_t clear = clear_alpha(snapshot);
  std::size_t of_final_search = 0;
  for (const LoopRecord& loop : *snapshot.loops) {
    if (loop.in_final_search && !loop.by_hand && of_final_search++ % stride != 0) continue;
    if (loop.verdict == LoopVerdict::kNotFound) continue;
    if (was_no_loop(loop.verdict) && !style.refused) continue;
    mrpt::img::TColor colour = loop_colour(loop, snapshot, style);
    const bool faint = loop.in_final_search || was_no_loop(loop.verdict);  // there are so many
    colour.A = faint ? kFaint : clear;
    CSetOfLines::Ptr& lines = by_colour[{!faint, colour.R, colour.G, colour.B}];
    if (!lines) lines = lines_of(colour, faint ? 1.0F : 1.5F);
    join(*lines, snapshot.map_T_node->at(loop.anchor), snapshot.map_T_node->at(loop.node), height_m::kLoops);
  }
  for (const auto& [key, lines] : by_colour) layer.insert(lines);
}

void draw_chosen_loop(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t index) {
  layer.clear();
  const LoopRecord& loop = (*snapshot.loops)[index];
  const TPose2D& anchor = snapshot.map_T_node->at(loop.anchor);
  const TPose2D& node = snapshot.map_T_node->at(loop.node);
  auto lines = lines_of(palette::kChosen, 4);
  join(*lines, anchor, node, height_m::kChosenLoop);
  layer.insert(lines);
  layer.insert(dots_of({raised(anchor, height_m::kChosenLoop), raised(node, height_m::kChosenLoop)},
                       palette::kChosen, 10));
}

}  // namespace psi_slam
