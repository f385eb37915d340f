// SPDX-License-Identifier: BSD-3-Clause
#include "gui/palette.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

using testing::ElementsAre;

using Reason = LoopRejection::Reason;

LoopRecord loop(MatcherKind matcher, std::optional<Reason> reason, double residual_m = 0) {
  LoopRecord record;
  record.node = 1;
  record.matcher = matcher;
  record.state = LoopState::kAccepted;
  if (reason) reject(record, {*reason});
  record.anchor_T_node.x = residual_m;
  return record;
}

class LoopLegendTest : public testing::Test {
 protected:
  LoopLegendTest() {
    snapshot_.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(2);
    snapshot_.loops = std::make_shared<std::vector<LoopRecord>>(std::vector<LoopRecord>{
        loop(MatcherKind::kGa, std::nullopt, 0.125), loop(MatcherKind::kCsm, std::nullopt, 9),
        loop(MatcherKind::kCsmGa, Reason::kLowResponse), loop(MatcherKind::kGa, Reason::kContradicted)});
  }
  std::vector<std::string> names(const LoopStyle& style) const {
    std::vector<std::string> result;
    for (const LoopLegend::Entry& entry : loop_legend(snapshot_, style).entries) result.push_back(entry.name);
    return result;
  }

  ReplaySnapshot snapshot_;
};

TEST_F(LoopLegendTest, names_only_what_is_drawn) {
  EXPECT_THAT(names({LoopStyle::Colour::kMatcher, false}), ElementsAre("csm", "ga", "rejected as outlier"));
  EXPECT_THAT(names({LoopStyle::Colour::kMatcher, true}),
              ElementsAre("csm", "ga", "rejected as outlier", "rejected otherwise"));
  EXPECT_THAT(names({LoopStyle::Colour::kResidual, false}),
              ElementsAre("0.00 m", "0.06 m", "0.12 m", "0.19 m", "0.25 m and more", "rejected as outlier"));
  EXPECT_TRUE(loop_legend(ReplaySnapshot(), {}).entries.empty());
}

TEST_F(LoopLegendTest, contains_the_colour_of_every_drawn_loop) {
  for (const auto colour : {LoopStyle::Colour::kMatcher, LoopStyle::Colour::kResidual}) {
    const LoopStyle style{colour, true};
    const LoopLegend legend = loop_legend(snapshot_, style);
    for (const LoopRecord& record : *snapshot_.loops) {
      const mrpt::img::TColor drawn = loop_colour(record, snapshot_, style);
      EXPECT_TRUE(std::any_of(legend.entries.begin(), legend.entries.end(),
                              [&](const LoopLegend::Entry& entry) { return entry.colour == drawn; }));
    }
  }
}

}  // namespace
}  // namespace psi_slam
