// SPDX-License-Identifier: BSD-3-Clause
// Maps the first half of real logs, and localizes the robot of the second half in this map. A map of the
// whole log gives the true poses. Each true pose is taken relative to the nearest pose of the first half,
// because the two maps differ by some centimetres. The test prints the figures of share/doc/localize.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

#include "../localization/degraded_map.h"
#include "localization/localization_report.h"
#include "localization/reference_map.h"
#include "logs/frames/pose_operations.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "session/settings.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kStarts = 12;
constexpr std::size_t kThreads = 4;
constexpr double kWay_m = 20;   // path length after which each localization ends
constexpr double kFalse_m = 1;  // position error above which a tracked pose counts as wrong
// Tracking is expected up to this distance from the path of the first half.
constexpr double kNear_m = 1;

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
  std::vector<double> errors_m;  ///< position errors of all tracked poses
  std::vector<double> found_after_m;
  std::vector<double> found_after_s;

  void add(const Figures& more) {
    found += more.found;
    within_5_m += more.within_5_m;
    wrong += more.wrong;
    const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(errors_m, more.errors_m);
    append(found_after_m, more.found_after_m);
    append(found_after_s, more.found_after_s);
  }
};

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Both halves of a log, and the true poses in the map of the first half.
struct Halves {
  MappingResult whole;
  std::size_t half = 0;
  MappingResult first;
  std::vector<TPose2D> map_T_robot;  ///< true poses of all scans in the map of the first half
  std::vector<double> from_first_m;  ///< distances of all scans from the nearest scan of the first half

  Halves(const std::filesystem::path& log, const Settings& settings)
      : whole(mapped(log, settings, static_cast<std::size_t>(-1))),
        half(whole.log.size() / 2),
        first(mapped(log, settings, half)) {
    for (std::size_t i = 0; i < whole.log.size(); ++i) {
      const TPose2D& here = whole.frames[i].map_T_robot;
      const auto nearest =
          std::min_element(whole.frames.begin(), whole.frames.begin() + static_cast<std::ptrdiff_t>(half),
                           [&](const FrameRecord& a, const FrameRecord& b) {
                             return distance_m(a.map_T_robot, here) < distance_m(b.map_T_robot, here);
                           });
      const auto at = static_cast<std::size_t>(nearest - whole.frames.begin());
      from_first_m.push_back(distance_m(nearest->map_T_robot, here));
      map_T_robot.push_back(first.frames[at].map_T_robot + (here - whole.frames[at].map_T_robot));
    }
  }

  ReferenceMap map(const Settings& settings) const {
    const auto grid = draw_grid_map(first.log, mapped_poses(first), settings.map);
    const LocalizerOptions options = localizer_options(settings);
    return make_reference_map(*grid, options.search.resolution_m, options.search.smoothing_sigma_m);
  }
};

void set_down_at(std::size_t start, const Halves& log, const ReferenceMap& map,
                 const LocalizerOptions& options, Figures& figures) {
  Localizer localizer(map, options);
  std::vector<LocalizationStep> steps;
  double way_m = 0;
  bool wrong = false;
  for (std::size_t i = start; i < log.whole.log.size() && way_m < kWay_m; ++i) {
    steps.push_back(localizer.add(log.whole.log[i]));
    way_m += steps.back().moved_m;
    if (steps.back().state != LocalizationStep::State::kTracking) continue;
    const double off_m = distance_m(steps.back().map_T_robot, log.map_T_robot[i]);
    figures.errors_m.push_back(off_m);
    wrong = wrong || off_m > kFalse_m;
  }
  const LocalizationSummary summary = summarize(steps);
  if (wrong) ++figures.wrong;
  if (!summary.found()) return;
  ++figures.found;
  if (*summary.found_after_m <= 5) ++figures.within_5_m;
  figures.found_after_m.push_back(*summary.found_after_m);
  figures.found_after_s.push_back(*summary.found_after_s);
}

Figures localize_second_half(const std::filesystem::path& log, const std::string& ini) {
  BoundSettings bound;
  bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/" + ini, {});
  const Halves halves(log, bound.settings);
  const LocalizerOptions options = localizer_options(bound.settings);
  const ReferenceMap map = halves.map(bound.settings);
  const std::size_t scans = halves.whole.log.size();
  std::vector<Figures> by_thread(kThreads);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < kThreads; ++thread)
    threads.emplace_back([&, thread] {
      for (std::size_t i = thread; i < kStarts; i += kThreads)
        set_down_at(halves.half + i * (scans - halves.half) / kStarts, halves, map, options,
                    by_thread[thread]);
    });
  for (std::thread& thread : threads) thread.join();
  Figures figures;
  for (const Figures& some : by_thread) figures.add(some);
  std::printf(
      "%s: %zu of %zu found within %.0f m of driving (%zu within 5 m), median %.1f m and %.1f s; %zu "
      "wrong; median error %.3f m\n",
      ini.c_str(), figures.found, kStarts, kWay_m, figures.within_5_m, median(figures.found_after_m),
      median(figures.found_after_s), figures.wrong, median(figures.errors_m));
  return figures;
}

TEST(LocalizeHalves, finds_robots_of_the_second_half_in_the_map_of_the_first) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  const auto log = shared_file("fr079.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const Figures figures = localize_second_half(*log, "fr079.ini");
  EXPECT_GE(figures.found, kStarts / 2);
  EXPECT_LE(figures.wrong, kStarts / 12);
  EXPECT_LT(median(figures.errors_m), 0.1);
}

/// Localizes the robot through the whole second half. With `told`, the localizer gets the start pose, taken
/// from the map of the whole log.
void follow_second_half(const Halves& log, const ReferenceMap& map, const LocalizerOptions& options,
                        bool told) {
  SCOPED_TRACE(told ? "told start" : "no start");
  Localizer localizer(map, options);
  if (told) localizer.start_at(log.whole.frames[log.half].map_T_robot);
  std::vector<LocalizationStep> steps;
  std::vector<double> errors_m;
  std::size_t near = 0;  // scans near the path of the first half
  std::size_t tracked_near = 0;
  for (std::size_t i = log.half; i < log.whole.log.size(); ++i) {
    steps.push_back(localizer.add(log.whole.log[i]));
    const bool is_near = log.from_first_m[i] <= kNear_m;
    near += is_near ? 1 : 0;
    if (steps.back().state != LocalizationStep::State::kTracking) continue;
    tracked_near += is_near ? 1 : 0;
    errors_m.push_back(distance_m(steps.back().map_T_robot, log.map_T_robot[i]));
  }
  const LocalizationSummary summary = summarize(steps);
  ASSERT_TRUE(summary.found());
  const auto count_above = [&](double limit_m) {
    return std::count_if(errors_m.begin(), errors_m.end(), [&](double error_m) { return error_m > limit_m; });
  };
  std::printf(
      "%s: found after %.1f m, %.1f s; %.1f %% of %zu scans tracked, of those within %.0f m of the first "
      "half's "
      "path %.1f %%; lost %d times, found %d times; error at first %.3f m, median %.3f m, largest %.3f m; at "
      "the "
      "end %s\n",
      told ? "told start" : "no start", *summary.found_after_m, *summary.found_after_s,
      100 * summary.tracked_share(), summary.scans, kNear_m,
      100 * static_cast<double>(tracked_near) / static_cast<double>(near), summary.times_lost,
      summary.times_found, errors_m.front(), median(errors_m),
      *std::max_element(errors_m.begin(), errors_m.end()),
      summary.localized_at_end() ? "localized" : "not localized");
  EXPECT_GT(static_cast<double>(tracked_near), 0.75 * static_cast<double>(near));
  EXPECT_LT(median(errors_m), 0.05);
  EXPECT_EQ(count_above(kFalse_m), 0);
  EXPECT_LT(errors_m.front(), 0.1);
}

TEST(LocalizeHalves, tracks_a_robot_through_the_second_half) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  const auto log = shared_file("intel.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  BoundSettings bound;
  bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/intel.ini", {});
  const Halves halves(*log, bound.settings);
  const ReferenceMap map = halves.map(bound.settings);
  std::vector<double> between_maps_m;
  for (std::size_t i = 0; i < halves.half; ++i)
    between_maps_m.push_back(
        distance_m(halves.first.frames[i].map_T_robot, halves.whole.frames[i].map_T_robot));
  const TPose2D moved = halves.whole.frames[0].map_T_robot - halves.first.frames[0].map_T_robot;
  std::printf(
      "intel.ini: the maps lie apart by %.3f m at the first scan, in the median %.3f m, at most %.3f m\n",
      std::hypot(moved.x, moved.y), median(between_maps_m),
      *std::max_element(between_maps_m.begin(), between_maps_m.end()));
  const LocalizerOptions options = localizer_options(bound.settings);
  std::thread told([&] { follow_second_half(halves, map, options, true); });
  follow_second_half(halves, map, options, false);
  told.join();
}

constexpr std::size_t kStretches = 10;  // of the second half of each log
constexpr double kStretch_s = 40;
constexpr double kOtherMap_m = 2;  // error above which a place is wrong; the two maps differ by up to 1.6 m
constexpr double kFirstForeignShare = 0.05;  // of a log whose building the map does not show

struct StretchCounts {
  std::size_t found = 0;
  std::size_t wrong = 0;
  std::size_t possible = 0;  ///< stretches in which a search met the true place, believed or not
  std::size_t searches = 0;
};

/// Sets a robot down at `first` and adds scans for kStretch_s, or until it is found. `map_T_robot` are the
/// true poses; empty: the map shows another building, so every place is wrong.
void localize_stretch(std::size_t first, const std::vector<Frame>& frames,
                      const std::vector<TPose2D>& map_T_robot, Localizer& localizer, StretchCounts& counts) {
  const auto is_right = [&](const TPose2D& place, std::size_t frame) {
    return !map_T_robot.empty() && distance_m(place, map_T_robot[frame]) <= kOtherMap_m;
  };
  bool possible = false;
  for (std::size_t i = first; i < frames.size(); ++i) {
    if (static_cast<double>(frames[i].time_us - frames[first].time_us) > 1e6 * kStretch_s) break;
    const LocalizationStep step = localizer.add(frames[i]);
    if (step.search) ++counts.searches;
    possible = possible || (step.search && step.search->found && is_right(step.search->map_T_robot, i));
    if (step.state != LocalizationStep::State::kTracking) continue;
    ++(is_right(step.map_T_robot, i) ? counts.found : counts.wrong);
    break;
  }
  if (possible) ++counts.possible;
}

StretchCounts localize_stretches(const std::vector<Frame>& frames, const std::vector<TPose2D>& map_T_robot,
                                 double from_share, const ReferenceMap& map,
                                 const LocalizerOptions& options) {
  StretchCounts counts;
  for (std::size_t k = 0; k < kStretches; ++k) {
    const double share = from_share + (1 - from_share) * static_cast<double>(k) / kStretches;
    Localizer localizer(map, options);
    localize_stretch(static_cast<std::size_t>(share * static_cast<double>(frames.size())), frames,
                     map_T_robot, localizer, counts);
  }
  return counts;
}

struct NamedFaults {
  const char* name;
  MapFaults faults;
};

/// Faults: displaced_cells, thickened_cells, ragged_share, speck_share, furniture_per_m2, merged_cells.
constexpr NamedFaults kFaults[] = {
    {"as drawn", {}},
    {"walls of 5 cells", {1, 2, 0, 0, 0, 1}},
    {"ragged walls and specks", {1, 0, 0.3, 0.005, 0, 1}},
    {"thick walls, specks, furniture", {1, 1, 0, 0.005, 1.0 / 12, 1}},
    {"cells of 0.1 m, thick and ragged walls, furniture", {0, 1, 0.3, 0, 1.0 / 12, 2}}};

TEST(LocalizeHalves, finds_robots_in_maps_like_those_of_other_programs) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  std::vector<std::string> names = {"mit-csail", "aces", "intel", "fr079"};
  std::vector<Settings> settings;
  std::vector<std::unique_ptr<Halves>> logs;
  for (const std::string& name : names) {
    const auto log = shared_file(name + ".clf.gz");
    if (!log) GTEST_SKIP() << kNeedsData;
    BoundSettings bound;
    bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/" + name + ".ini", {});
    settings.push_back(bound.settings);
    logs.push_back(std::make_unique<Halves>(*log, bound.settings));
  }
  for (const NamedFaults& kind : kFaults) {
    std::size_t found = 0;
    std::size_t possible = 0;
    for (std::size_t m = 0; m < logs.size(); ++m) {
      const auto drawn = draw_grid_map(logs[m]->first.log, mapped_poses(logs[m]->first), settings[m].map);
      const LocalizerOptions options = localizer_options(settings[m]);
      const ReferenceMap map = make_reference_map(degraded(*drawn, kind.faults), options.search.resolution_m,
                                                  options.search.smoothing_sigma_m);
      const StretchCounts own =
          localize_stretches(logs[m]->whole.log, logs[m]->map_T_robot, 0.5, map, options);
      StretchCounts foreign;
      for (std::size_t other = 0; other < logs.size(); ++other) {
        if (other == m) continue;
        const StretchCounts some =
            localize_stretches(logs[other]->whole.log, {}, kFirstForeignShare, map, options);
        foreign.wrong += some.wrong;
        foreign.searches += some.searches;
      }
      std::printf(
          "%s, %s: %zu of %zu found (true place met in %zu), %zu wrong; other buildings: %zu of %zu "
          "found, %zu searches\n",
          names[m].c_str(), kind.name, own.found, kStretches, own.possible, own.wrong, foreign.wrong,
          (logs.size() - 1) * kStretches, foreign.searches);
      EXPECT_EQ(own.wrong, 0U) << names[m] << ", " << kind.name;
      EXPECT_EQ(foreign.wrong, 0U) << names[m] << ", " << kind.name;
      found += own.found;
      possible += own.possible;
    }
    EXPECT_GE(static_cast<double>(found), 0.5 * static_cast<double>(possible)) << kind.name;
  }
}

}  // namespace
}  // namespace psi_slam
