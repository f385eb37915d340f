// SPDX-License-Identifier: BSD-3-Clause
// Parts of describe() of settings.h that describe some of the sections.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/option_table.h"
#include "session/settings.h"

namespace psi_slam {

/// Returns the matchers with their names, for an option of type MatcherKind or std::optional<MatcherKind>.
template <class Choice>
std::vector<std::pair<std::string, Choice>> matcher_choices() {
  std::vector<std::pair<std::string, Choice>> choices;
  for (const MatcherKind kind : kMatcherKinds) choices.emplace_back(name(kind), kind);
  return choices;
}

/// Describes the options refine_* in the current section of the table.
void describe_refinement(OptionTable& table, RefinementOptions& refinement);

/// Describes the sections from [loop_closure] to [joint_refinement].
void describe_loops(OptionTable& table, MapperOptions& mapper);

}  // namespace psi_slam
