// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/localization/localizer.h"

#include <gmock/gmock.h>

#include "psi_slam/localization/localization_report.h"
#include "simulated_drives.h"
#include <chrono>
#include <iostream>

namespace psi_slam {
namespace {
using State = LocalizationStep::State;
TEST(Explore, all) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    const TrueDrive mapping = drive_through(seed, seed, 200);
    const auto grid = map_of(mapping);
    for (unsigned other : {0U, 50U}) {
      const TrueDrive drive = drive_through(seed + other, seed + 100, 60);
      const auto begin = std::chrono::steady_clock::now();
      Localizer localizer(reference_of(grid), {});
      const auto steps = localize(localizer, drive.frames);
      double worst = 0;
      for (size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].search) {
          const auto& s = *steps[i].search;
          printf("  search at %zu resp %.2f amb %.2f obs %.2f agree %.2f rev %.2f off %.2f %s\n", i, s.response, s.ambiguity, s.observed_share, s.agree, s.clear_share, distance_m(s.map_T_robot, drive.world_T_robot[i]), s.objection.c_str());
        }
        if (steps[i].state == State::kTracking) worst = std::max(worst, distance_m(steps[i].map_T_robot, drive.world_T_robot[i]));
      }
      printf("seed %u other %u grid %dx%d: worst %.3f, %.1f s\n%s\n", seed, other, static_cast<int>(grid.getSizeX()), static_cast<int>(grid.getSizeY()), worst,
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), localization_text(summarize(steps)).c_str());
    }
  }
}
}  // namespace
}  // namespace psi_slam
