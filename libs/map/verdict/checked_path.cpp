// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/checked_path.h"

#include <algorithm>
#include <map>
#include <utility>

namespace psi_slam {

double held_share(const std::vector<MapView>& views, const std::vector<PassCheck>& checks,
                  double spot_error_m) {
  std::vector<int> begins(views.size() + 1, 0);  // minus the ends, of the held parts at each view
  const auto hold = [&](std::size_t first, std::size_t last) {
    ++begins[first];
    --begins[last + 1];
  };
  struct Joints {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Joints> joints;  // of a run with another run
  const auto join = [&](std::size_t view, std::size_t other) {
    Joints& of_pair =
        joints.try_emplace({views[view].run, views[other].run}, Joints{view, view}).first->second;
    of_pair.first = std::min(of_pair.first, view);
    of_pair.last = std::max(of_pair.last, view);
  };
  for (const PassCheck& check : checks) {
    if (check.same_pass || check.scene_changed || check.error_m >= spot_error_m) continue;
    if (views[check.view].run == views[check.other].run) {
      hold(std::min(check.view, check.other), std::max(check.view, check.other));
    } else {
      join(check.view, check.other);
      join(check.other, check.view);
    }
  }
  for (const auto& [runs, of_pair] : joints) hold(of_pair.first, of_pair.last);
  std::size_t held = 0;
  int parts = 0;
  for (std::size_t view = 0; view < views.size(); ++view) held += (parts += begins[view]) > 0 ? 1 : 0;
  return views.empty() ? 0 : static_cast<double>(held) / static_cast<double>(views.size());
}

std::vector<UncheckedStretch> unchecked_stretches(const std::vector<MapView>& views,
                                                  const std::vector<std::optional<double>>& errors_m,
                                                  const std::vector<std::optional<double>>& sigmas_m,
                                                  double least_length_m) {
  std::vector<UncheckedStretch> stretches;
  for (std::size_t first = 0; first < views.size();) {
    std::size_t end = first;
    std::optional<double> sigma_m = sigmas_m[first];
    for (; end < views.size() && !errors_m[end] && views[end].run == views[first].run; ++end)
      sigma_m = sigma_m && sigmas_m[end] ? std::optional(std::max(*sigma_m, *sigmas_m[end])) : std::nullopt;
    if (end == first) {
      ++first;
      continue;
    }
    const MapView& from = views[first];
    const MapView& to = views[end - 1];
    first = end;
    if (to.travelled_m - from.travelled_m < least_length_m) continue;
    stretches.push_back({from.frame,
                         to.frame,
                         to.travelled_m - from.travelled_m,
                         {from.map_T_robot.x, from.map_T_robot.y},
                         {to.map_T_robot.x, to.map_T_robot.y},
                         sigma_m});
  }
  std::stable_sort(stretches.begin(), stretches.end(),
                   [](const UncheckedStretch& a, const UncheckedStretch& b) {
                     return b.sigma_m && (!a.sigma_m || *a.sigma_m > *b.sigma_m);
                   });
  return stretches;
}

}  // namespace psi_slam
