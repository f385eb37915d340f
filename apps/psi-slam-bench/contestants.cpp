// SPDX-License-Identifier: BSD-3-Clause
#include "contestants.h"

#include <algorithm>
#include <stdexcept>

#include "psi_slam/matching/correlative_matcher.h"

namespace psi_slam {

const Matcher& Contestant::matcher(const LoopCase& loop_case) const {
  if (matchers_.size() == 1) return *matchers_.front();
  const auto named = std::find_if(matchers_.begin(), matchers_.end(), [&](const auto& matcher) {
    return matcher->name() == loop_case.adaptive_matcher;
  });
  if (named == matchers_.end())
    throw std::logic_error("no matcher is called \"" + loop_case.adaptive_matcher + '"');
  return **named;
}

std::vector<Contestant> contestants(Field, const MapperOptions& options) {
  const auto csm = std::make_shared<CorrelativeMatcher>(options.loop_matcher);
  return {{"csm", csm}};
}

}  // namespace psi_slam
