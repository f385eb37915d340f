// SPDX-License-Identifier: BSD-3-Clause
#include "gui/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "base/number_text.h"
#include "gui/loop_picture.h"

namespace psi_slam {
namespace {

using mrpt::img::TColor;

constexpr int kResidualShades = 8;
constexpr int kScaleSteps = 4;  // number of steps in the legend's scale of residuals

}  // namespace

TColor matcher_colour(MatcherKind matcher) {
  static const std::map<MatcherKind, TColor> kColours{{MatcherKind::kCsm, {117, 76, 180}},
                                                      {MatcherKind::kCsmGa, {0, 122, 204}},
                                                      {MatcherKind::kGa, {0, 145, 90}}};
  return kColours.at(matcher);
}

TColor state_colour(const LoopRecord& loop) {
  if (loop.state == LoopState::kAccepted) return {0, 130, 70};
  if (loop.state == LoopState::kCandidate) return {176, 112, 0};
  return is_outlier(loop) ? TColor(196, 30, 40) : TColor(120, 124, 130);
}

TColor map_edit_colour(MapEdit::Kind kind) {
  static const std::map<MapEdit::Kind, TColor> kColours{
      {MapEdit::Kind::kErase, {0, 122, 204}},   {MapEdit::Kind::kUnknown, {117, 76, 180}},
      {MapEdit::Kind::kWall, {20, 24, 32}},     {MapEdit::Kind::kCrop, {0, 130, 70}},
      {MapEdit::Kind::kKeepOut, {196, 30, 40}}, {MapEdit::Kind::kSlow, {214, 132, 0}}};
  return kColours.at(kind);
}

TColor heat_colour(double share) {
  constexpr std::array<std::array<double, 3>, 3> kStops{{{26, 150, 65}, {240, 190, 40}, {200, 20, 30}}};
  const double at = std::clamp(share, 0.0, 1.0) * 2;
  const auto first = static_cast<std::size_t>(std::min(std::floor(at), 1.0));
  const double u = at - static_cast<double>(first);
  const auto mixed = [&](std::size_t channel) {
    const double value = kStops[first][channel] * (1 - u) + kStops[first + 1][channel] * u;
    return static_cast<std::uint8_t>(std::lround(value));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

TColor loop_colour(const LoopRecord& loop, const ReplaySnapshot& snapshot, const LoopStyle& style) {
  if (loop.state != LoopState::kAccepted) return state_colour(loop);
  if (style.colour == LoopStyle::Colour::kMatcher) return matcher_colour(loop.matcher);
  const double share = loop_residual_m(loop, *snapshot.map_T_node) / kWorstResidual_m;
  return heat_colour(std::round(share * kResidualShades) / kResidualShades);
}

LoopLegend loop_legend(const ReplaySnapshot& snapshot, const LoopStyle& style) {
  LoopLegend legend;
  const auto add = [&](const char* name, const auto& belongs) {
    const auto loop = std::find_if(snapshot.loops->begin(), snapshot.loops->end(), belongs);
    if (loop != snapshot.loops->end()) legend.entries.push_back({name, loop_colour(*loop, snapshot, style)});
  };
  const auto is_accepted = [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; };
  if (style.colour == LoopStyle::Colour::kMatcher) {
    legend.title = "Loops, by matcher";
    for (const MatcherKind matcher : kMatcherKinds)
      add(name(matcher),
          [&](const LoopRecord& loop) { return is_accepted(loop) && loop.matcher == matcher; });
  } else if (std::any_of(snapshot.loops->begin(), snapshot.loops->end(), is_accepted)) {
    legend.title = "Loops, by residual";
    for (int step = 0; step <= kScaleSteps; ++step) {
      const double share = static_cast<double>(step) / kScaleSteps;
      const char* const unit = step == kScaleSteps ? " m and more" : " m";
      legend.entries.push_back({fixed_text(share * kWorstResidual_m, 2) + unit, heat_colour(share)});
    }
  }
  add("candidate", [](const LoopRecord& loop) { return loop.state == LoopState::kCandidate; });
  add("rejected as outlier", is_outlier);
  if (style.rejected)
    add("rejected otherwise", [](const LoopRecord& loop) {
      return loop.state == LoopState::kRejected && !is_outlier(loop) && !found_nothing(loop);
    });
  if (legend.title.empty()) legend.title = "Loops";
  return legend;
}

}  // namespace psi_slam
