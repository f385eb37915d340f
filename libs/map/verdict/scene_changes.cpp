// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/scene_changes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "logs/frames/pose_operations.h"
#include "mapping/scan_place.h"

namespace psi_slam {
namespace {

constexpr double kOnePlace_m = 2;
constexpr std::size_t kMostNamed = 3;

}  // namespace

std::vector<SceneChange> scene_changes(const MappingResult& result, const std::vector<MapView>& views,
                                       const std::vector<PassCheck>& checks, std::size_t least_checks) {
  struct Place {
    SceneChange change;
    std::size_t checks = 0;
  };
  std::vector<Place> places;
  const auto time_s = [&](std::size_t view) {
    return seconds(result.frames[views[view].frame].time_us - result.frames.front().time_us);
  };
  for (const PassCheck& check : checks) {
    if (!check.scene_changed || check.same_pass) continue;
    const auto [before_s, after_s] = std::minmax({time_s(check.view), time_s(check.other)});
    auto place = std::find_if(places.begin(), places.end(), [&](const Place& one) {
      return distance_m(one.change.at, check.scans.at) <= kOnePlace_m;
    });
    if (place == places.end()) place = places.insert(place, {{check.scans.at, before_s, after_s}, 0});
    place->change.before_s = std::max(place->change.before_s, before_s);
    place->change.after_s = std::min(place->change.after_s, after_s);
    ++place->checks;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.checks > b.checks; });
  std::vector<SceneChange> changes;
  for (const Place& place : places)
    if (place.checks >= least_checks && place.change.before_s < place.change.after_s)
      changes.push_back(place.change);
  return changes;
}

std::string text_of(const std::vector<SceneChange>& changes) {
  if (changes.empty()) return {};
  std::string text = "the building changed at ";
  for (std::size_t i = 0; i < std::min(kMostNamed, changes.size()); ++i) {
    const SceneChange& change = changes[i];
    text += (i == 0 ? "" : ", ") + place_text(change.at);
    if (change.before_s >= 0)
      text += " between " + minutes_text(std::floor(change.before_s)) + " and " +
              minutes_text(std::ceil(change.after_s));
  }
  if (changes.size() > kMostNamed) text += " and at " + counted(changes.size() - kMostNamed, "further place");
  return text;
}

}  // namespace psi_slam
