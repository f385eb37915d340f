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

TColor verdict_colour(LoopVerdict verdict) {
  static const std::map<LoopVerdict, TColor> kColours{
      {LoopVerdict::kAccepted, {0, 130, 70}},    {LoopVerdict::kPending, {176, 112, 0}},
      {LoopVerdict::kRefused, {120, 124, 130}},  {LoopVerdict::kSwitchedOff, {196, 30, 40}},
      {LoopVerdict::kNotFound, {160, 164, 170}}, {LoopVerdict::kDeleted, {150, 20, 110}}};
  return kColours.at(verdict);
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

bool was_no_loop(LoopVerdict verdict) {
  return verdict == LoopVerdict::kRefused || verdict == LoopVerdict::kDeleted;
}

TColor loop_colour(const LoopRecord& loop, const ReplaySnapshot& snapshot, const LoopStyle& style) {
  if (loop.verdict != LoopVerdict::kAccepted) return verdict_colour(loop.verdict);
  if (style.colour == LoopStyle::Colour::kMatcher) return matcher_colour(loop.matcher);
  const double share = loop_residual_m(loop, *snapshot.map_T_node) / kWorstResidual_m;
  return heat_colour(std::round(share * kResidualShades) / kResidualShades);
}

LoopLegend loop_legend(const ReplaySnapshot& snapshot, const LoopStyle& style) {
  const auto any = [&](const auto& condition) {
    return std::any_of(snapshot.loops->begin(), snapshot.loops->end(), condition);
  };
  const auto any_with = [&](LoopVerdict verdict) {
    return any([verdict](const LoopRecord& loop) { return loop.verdict == verdict; });
  };
  LoopLegend legend;
  if (style.colour == LoopStyle::Colour::kMatcher) {
    legend.title = "Loops, by matcher";
    for (const MatcherKind matcher : kMatcherKinds)
      if (any([&](const LoopRecord& loop) {
            return loop.verdict == LoopVerdict::kAccepted && loop.matcher == matcher;
          }))
        legend.entries.push_back({name(matcher), matcher_colour(matcher)});
  } else if (any_with(LoopVerdict::kAccepted)) {
    legend.title = "Loops, by residual";
    for (int step = 0; step <= kScaleSteps; ++step) {
      const double share = static_cast<double>(step) / kScaleSteps;
      const char* const unit = step == kScaleSteps ? " m and more" : " m";
      legend.entries.push_back({fixed_text(share * kWorstResidual_m, 2) + unit, heat_colour(share)});
    }
  }
  for (const LoopVerdict verdict :
       {LoopVerdict::kPending, LoopVerdict::kSwitchedOff, LoopVerdict::kRefused, LoopVerdict::kDeleted})
    if ((style.refused || !was_no_loop(verdict)) && any_with(verdict))
      legend.entries.push_back({verdict_text(verdict), verdict_colour(verdict)});
  if (legend.title.empty()) legend.title = "Loops";
  return legend;
}

}  // namespace psi_slam
