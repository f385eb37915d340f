// SPDX-License-Identifier: BSD-3-Clause
// The parts of describe() of settings.h, each of some sections of the settings.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "config/option_table.h"
#include "session/settings.h"

namespace psi_slam {

/// The matchers by name, for an option of type MatcherKind or std::optional<MatcherKind>.
template <class Choice>
std::vector<std::pair<std::string, Choice>> matcher_choices() {
  std::vector<std::pair<std::string, Choice>> choices;
  for (const MatcherKind kind : kMatcherKinds) choices.emplace_back(name(kind), kind);
  return choices;
}

/// Members of a section that the caller has begun.
void describe_refinement(OptionTable& table, RefinementOptions& refinement);

/// From the search for loops to the refinement of all scans.
void describe_loops(OptionTable& table, MapperOptions& mapper);
void describe_map(OptionTable& table, GridMapOptions& map);
void describe_map_files(OptionTable& table, MapFileOptions& files);
void describe_localization(OptionTable& table, LocalizerOptions& localization);

}  // namespace psi_slam
