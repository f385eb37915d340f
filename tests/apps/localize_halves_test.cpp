// SPDX-License-Identifier: BSD-3-Clause
// Real logs: the first half is mapped, and robots are set down all over the second. The path of the whole
// log, mapped at once, is what their poses are compared with. It prints the figures of share/doc/localize.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "psi_slam/localization/localization_report.h"
#include "psi_slam/session/bound_settings.h"
#include "psi_slam/session/mapping_session.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

constexpr std::size_t kStarts = 24;
constexpr double kWay_m = 20;   // that each robot drives at most
constexpr double kFalse_m = 1;  // farther from the path, a place found is a false one

MappingResult mapped(const std::filesystem::path& log, const Settings& settings, std::size_t scans) {
  MappingSession session(log, settings);
  for (std::size_t i = 0; i < scans && session.step(); ++i) {
  }
  session.finish();
  return session.result();
}

struct Figures {
  std::size_t found = 0;
  std::size_t within_5_m = 0;
  std::size_t wrong = 0;
  std::vector<double> errors_m;  ///< of all poses tracked
  std::vector<double> found_after_m;
  std::vector<double> found_after_s;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void set_down_at(std::size_t start, const MappingResult& whole, const ReferenceMap& map,
                 const LocalizerOptions& options, Figures& figures) {
  Localizer localizer(map, options);
  std::vector<LocalizationStep> steps;
  double way_m = 0;
  bool wrong = false;
  for (std::size_t i = start; i < whole.log.size() && way_m < kWay_m; ++i) {
    steps.push_back(localizer.add(whole.log[i]));
    way_m += steps.back().moved_m;
    if (steps.back().state != LocalizationStep::State::kTracking) continue;
    const auto& truth = whole.frames[i].map_T_robot;
    const double off_m =
        std::hypot(steps.back().map_T_robot.x - truth.x, steps.back().map_T_robot.y - truth.y);
    figures.errors_m.push_back(off_m);
    wrong = wrong || off_m > kFalse_m;
  }
  const LocalizationSummary summary = summarize(steps);
  if (wrong) ++figures.wrong;
  if (!summary.localized()) return;
  ++figures.found;
  if (*summary.found_after_m <= 5) ++figures.within_5_m;
  figures.found_after_m.push_back(*summary.found_after_m);
  figures.found_after_s.push_back(*summary.found_after_s);
}

Figures localize_second_half(const std::filesystem::path& log, const std::string& ini) {
  BoundSettings bound;
  bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/" + ini, {});
  const MappingResult whole = mapped(log, bound.settings, static_cast<std::size_t>(-1));
  const std::size_t half = whole.log.size() / 2;
  const MappingResult first = mapped(log, bound.settings, half);
  const auto grid = draw_grid_map(first.log, mapped_poses(first), bound.settings.map);
  const LocalizerOptions options = localizer_options(bound.settings);
  const ReferenceMap map =
      make_reference_map(*grid, options.search.resolution_m, options.search.smoothing_sigma_m);
  Figures figures;
  for (std::size_t i = 0; i < kStarts; ++i)
    set_down_at(half + i * (whole.log.size() - half) / kStarts, whole, map, options, figures);
  std::printf(
      "%s: %zu of %zu found within %.0f m of driving (%zu within 5 m), median %.1f m and %.1f s; %zu "
      "wrong; median error %.3f m\n",
      ini.c_str(), figures.found, kStarts, kWay_m, figures.within_5_m, median(figures.found_after_m),
      median(figures.found_after_s), figures.wrong, median(figures.errors_m));
  return figures;
}

TEST(LocalizeHalves, robots_of_the_second_half_of_a_real_log_are_found_in_the_map_of_the_first) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr)
    GTEST_SKIP() << "takes a quarter of an hour: set PSI_SLAM_LONG_TESTS";
  const auto log = shared_file("fr079.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const Figures figures = localize_second_half(*log, "fr079.ini");
  EXPECT_GE(figures.found, kStarts / 2);
  EXPECT_LE(figures.wrong, kStarts / 12);
  EXPECT_LT(median(figures.errors_m), 0.1);
}

}  // namespace
}  // namespace psi_slam
