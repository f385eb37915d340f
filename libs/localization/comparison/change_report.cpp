// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/change_report.h"

#include <mrpt/core/bits_math.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number_text.h"

namespace psi_slam {
namespace {

using Kind = WallChange::Kind;

constexpr std::array<Kind, 3> kKinds{Kind::kAppeared, Kind::kVanished, Kind::kMoved};

struct Sum {
  std::size_t walls = 0;
  double length_m = 0;
};

Sum sum_of(const WallChanges& walls, Kind kind) {
  Sum sum;
  for (const WallChange& change : walls.changes) {
    if (change.kind != kind) continue;
    ++sum.walls;
    sum.length_m += change.length_m;
  }
  return sum;
}

const char* name(MapAlignment::Method method) {
  switch (method) {
    case MapAlignment::Method::kGiven:
      return "given";
    case MapAlignment::Method::kNearby:
      return "nearby";
    case MapAlignment::Method::kWholeMap:
      return "whole_map";
  }
  return "";
}

std::string alignment_text(const MapAlignment& alignment) {
  if (alignment.method == MapAlignment::Method::kGiven) return "The maps were compared without alignment";
  const auto& [x_m, y_m, yaw_rad] = alignment.a_T_b;
  return "B lies in A at x " + fixed_text(x_m, 3) + " m, y " + fixed_text(y_m, 3) + " m, yaw " +
         fixed_text(mrpt::RAD2DEG(yaw_rad), 2) + " degrees, with standard deviations of " +
         fixed_text(alignment.sigma_m(0), 3) + " m and " +
         fixed_text(mrpt::RAD2DEG(std::sqrt(alignment.covariance(2, 2))), 3) + " degrees; " +
         fixed_text(100 * alignment.agree, 0) + " % of the walls agree";
}

}  // namespace

const char* name(Kind kind) {
  switch (kind) {
    case Kind::kAppeared:
      return "appeared";
    case Kind::kVanished:
      return "vanished";
    case Kind::kMoved:
      return "moved";
  }
  return "";
}

std::string comparison_text(const MapComparison& comparison) {
  const WallChanges& walls = comparison.walls;
  std::string text;
  for (const Kind kind : kKinds) {
    const Sum sum = sum_of(walls, kind);
    if (sum.walls == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(sum.walls) + ' ' + name(kind) + " (" +
            fixed_text(sum.length_m, 1) + " m)";
  }
  const std::string compared = " in the " + fixed_text(walls.compared_m2, 0) + " m² that both maps show";
  return (text.empty() ? "No wall has changed" + compared
                       : counted(walls.changes.size(), "wall") + " changed" + compared + ": " + text) +
         ".\n" + alignment_text(comparison.alignment) + ".\n";
}

std::string comparison_json(const MapComparison& comparison) {
  const MapAlignment& alignment = comparison.alignment;
  const auto sigma = [&](int i) { return std::sqrt(alignment.covariance(i, i)); };
  nlohmann::ordered_json json;
  json["changed"] = comparison.changed();
  json["alignment"] = {{"method", name(alignment.method)},
                       {"x_m", alignment.a_T_b.x},
                       {"y_m", alignment.a_T_b.y},
                       {"yaw_rad", alignment.a_T_b.phi},
                       {"centre_m", {alignment.centre.x, alignment.centre.y}},
                       {"sigma_x_m", sigma(0)},
                       {"sigma_y_m", sigma(1)},
                       {"sigma_yaw_rad", sigma(2)},
                       {"agree", alignment.agree},
                       {"ambiguity", alignment.ambiguity ? nlohmann::ordered_json(*alignment.ambiguity)
                                                         : nlohmann::ordered_json()}};
  json["tolerance_m"] = comparison.limits.tolerance_m;
  json["min_length_m"] = comparison.limits.min_length_m;
  json["compared_m2"] = comparison.walls.compared_m2;
  for (const Kind kind : kKinds) {
    const Sum sum = sum_of(comparison.walls, kind);
    json[name(kind)] = {{"walls", sum.walls}, {"length_m", sum.length_m}};
  }
  return json.dump(2) + '\n';
}

std::string changes_csv(const std::vector<WallChange>& changes) {
  std::string text = "kind,x_m,y_m,from_x_m,from_y_m,to_x_m,to_y_m,length_m,shift_m,shift_x_m,shift_y_m\n";
  const auto values = [&](std::initializer_list<double> numbers) {
    for (const double number : numbers) text += ',' + fixed_text(number, 3);
  };
  for (const WallChange& change : changes) {
    const auto middle = change.middle();
    text += name(change.kind);
    values({middle.x, middle.y, change.from.x, change.from.y, change.to.x, change.to.y, change.length_m});
    if (change.kind == Kind::kMoved)
      values({change.shift.norm(), change.shift.x, change.shift.y});
    else
      text += ",,,";
    text += '\n';
  }
  return text;
}

}  // namespace psi_slam
