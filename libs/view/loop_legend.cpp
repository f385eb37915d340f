// SPDX-License-Identifier: BSD-3-Clause
#include "view/loop_legend.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "psi_slam/loop_record.h"
#include "view/loop_picture.h"
#include "view/palette.h"

namespace psi_slam {
namespace {

constexpr int kResidualShades = 8;
constexpr int kScaleSteps = 4;  // of the legend's scale

}  // namespace

bool was_no_loop(LoopVerdict verdict) {
  return verdict == LoopVerdict::kRefused || verdict == LoopVerdict::kDeleted;
}

mrpt::img::TColor loop_colour(const LoopRecord& loop, const ReplaySnapshot& snapshot,
                              const LoopStyle& style) {
  if (loop.verdict != LoopVerdict::kAccepted) return verdict_colour(loop.verdict);
  if (style.colour == LoopStyle::Colour::kMatcher) return matcher_colour(loop.matcher);
  const double share = loop_residual(loop, *snapshot.map_T_node).distance_m / kWorstResidual_m;
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
