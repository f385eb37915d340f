// SPDX-License-Identifier: BSD-3-Clause
// Settings with a member of every type that an option can have, and their descriptions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "base/config/option_table.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

enum class SampleMatcher { kCsm, kGa };

struct SampleSettings {
  double window_x_m = 0.15;
  double window_theta_rad = 0.07;
  SampleMatcher matcher = SampleMatcher::kCsm;
  bool close_loops = true;
  int passes = 2;
  std::size_t nodes = 60;
  std::uint64_t seed = 1;
  std::optional<double> max_range_m;
  std::optional<double> field_of_view_rad = 3.0;
  std::string label = "front laser; \"old\" # \\ one";
  double psi_1 = -0.0;
};

inline OptionTable describe(SampleSettings& settings) {
  OptionTable table;
  table.section("front_end", "Matching each scan with the active local map")
      .number("window_x_m", settings.window_x_m, between(0.01, 20), "m", "half-width of the search window")
      .angle_deg("window_theta_deg", settings.window_theta_rad, above(0).at_most(180),
                 "half-width in heading")
      .choice("matcher", settings.matcher, {{"csm", SampleMatcher::kCsm}, {"ga", SampleMatcher::kGa}},
              "search method")
      .flag("close_loops", settings.close_loops, "whether loops are closed")
      .integer("passes", settings.passes, between(-5, 5), "", "global passes | at the end")
      .integer("nodes", settings.nodes, at_least(1), "nodes", "size of a local map");
  table.section("log", "Reading the log")
      .integer("seed", settings.seed, any_number(), "", "seed of the random numbers")
      .optional_number("max_range_m", settings.max_range_m, above(0), "m", "maximum range")
      .optional_angle_deg("field_of_view_deg", settings.field_of_view_rad, above(0).at_most(360),
                          "field of view of the laser")
      .text("label", settings.label, "name of the laser");
  table.section("psi", "Loop closure factor of equation 13")
      .number("psi_1", settings.psi_1, any_number(), "", "weight");
  return table;
}

/// Text of the UserError that `action` throws, or "(nothing was thrown)".
template <class Action>
std::string sentence(Action action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

}  // namespace psi_slam
