// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings_parts.h"

namespace psi_slam {

void describe_localization(OptionTable& table, LocalizerOptions& localization) {
  GlobalSearchOptions& search = localization.search;
  table.section("localization", "psi-slam localize: a robot in a finished map")
      .choice("matcher", search.matcher,
              matcher_choices<MatcherKind>(),
              "that searches the whole map while the robot is lost")
      .number("search_resolution_m", search.resolution_m, between(0.005, 10), "m",
              "cells of that search, where they are larger than the map's")
      .number("search_travel_m", localization.search_travel_m, above(0), "m",
              "from one of these searches to the next")
      .number("context_travel_m", search.context.travel_m, at_least(0), "m",
              "of the way before, whose scans are looked for together")
      .number("context_node_spacing_m", search.context.node_spacing_m, at_least(0), "m",
              "scans of it nearer to each other along the way are left out")
      .number("context_point_spacing_m", search.context.point_spacing_m, above(0), "m",
              "one point of it for each square of this size")
      .number("min_search_response", search.min_response, between(0, 1), "", "least response of a place")
      .number("max_ambiguity", search.max_ambiguity, between(0, 1), "",
              "greatest response of another place of the map, as a share of the best; the nearer to 1, the "
              "more searches must agree")
      .number("min_search_observed_share", search.min_observed_share, between(0, 1), "",
              "least share of the scans' points where the map shows anything, at a place found")
      .number("min_search_agree", search.min_agree, between(0, 1), "",
              "least share of those points, on the map's walls")
      .number("min_clear_share", search.min_clear_share, between(0, 1), "",
              "least share of the beams that go through no wall at a place found")
      .number("min_response", localization.min_response, between(0, 1), "",
              "while tracking: least response of a scan")
      .number("min_agree", localization.min_agree, between(0, 1), "",
              "while tracking: least share of a scan's points, where the map shows anything, on its walls")
      .number("min_observed_share", localization.min_observed_share, between(0, 1), "",
              "while tracking: least share of a scan's points where the map shows anything")
      .number("window_m", localization.window_m, above(0).at_most(100), "m",
              "while tracking: half-width of the search window")
      .angle_deg("window_theta_deg", localization.window_rad, above(0).at_most(180), "the same in heading")
      .number("prior_sigma_m", localization.prior_sigma_m, above(0).at_most(100), "m",
              "while tracking: standard deviation of the prediction, which holds the pose where the scan "
              "does not")
      .angle_deg("prior_sigma_theta_deg", localization.prior_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .number("start_window_m", localization.start_window_m, above(0).at_most(100), "m",
              "half-width of the first window around --start")
      .angle_deg("start_window_theta_deg", localization.start_window_rad, above(0).at_most(180),
                 "the same in heading")
      .number("max_misfit_m", localization.max_misfit_m, at_least(0), "m",
              "the robot is lost when scans have not fitted for so much travel")
      .number("max_misfit_s", localization.max_misfit_s, at_least(0), "s", "or for so long");
}

}  // namespace psi_slam
