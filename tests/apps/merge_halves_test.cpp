// SPDX-License-Identifier: BSD-3-Clause
// Merges the two halves of a real log without a start pose. Odometry of the second half has another origin.
// The mean errors over the relations must stay below 1.1 times those in a map of the whole log. Prints the
// figures of share/doc/sessions.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "map/exports/mapped_trajectory.h"
#include "map/report/output_folder.h"
#include "map/trajectory/relations_metric.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "session/place_run.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

SessionInput input_of(const std::string& name, std::vector<Frame> frames, const TPose2D& other_T_odom) {
  auto recording = std::make_shared<SessionRecording>();
  for (Frame& frame : frames) frame.odom_T_robot = other_T_odom + frame.odom_T_robot;
  recording->facts.logs = {{name, name, frames.size()}};
  recording->frames = std::move(frames);
  return SessionInput(recording);
}

std::vector<Frame> frames_of(const std::filesystem::path& log, const Settings& settings) {
  std::vector<Frame> frames;
  const auto source = open_log(log, log_options(settings));
  while (std::optional<Frame> frame = source->next()) frames.push_back(*std::move(frame));
  return frames;
}

RelationsMetric errors_of(const MappingResult& result, const std::filesystem::path& relations) {
  return evaluate_relations(trajectory_of(result.frames), read_relations(relations));
}

/// Largest distance in metres between the two poses of a scan. Poses are relative to the first of their map.
double largest_difference_m(const MappingResult& a, const MappingResult& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const TPose2D here = a.frames[i].map_T_robot - a.frames[0].map_T_robot;
    const TPose2D there = b.frames[i].map_T_robot - b.frames[0].map_T_robot;
    largest = std::max(largest, std::hypot(here.x - there.x, here.y - there.y));
  }
  return largest;
}

void merge_halves_of(const std::string& name, double odometry_x_m, double odometry_yaw_rad) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  const auto log = shared_file(name + ".clf.gz");
  const auto relations = shared_file(name + ".relations");
  if (!log || !relations) GTEST_SKIP() << kNeedsData;
  BoundSettings bound;
  bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/" + name + ".ini", {});
  const std::atomic<bool> go_on{false};
  const std::vector<Frame> frames = frames_of(*log, bound.settings);
  const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
  const SessionInput first = input_of("first", {frames.begin(), middle}, {0, 0, 0});
  const SessionInput second =
      input_of("second", {middle, frames.end()}, {odometry_x_m, -3.0, odometry_yaw_rad});

  MappingSession whole(input_of("whole", frames, {0, 0, 0}), bound.settings);
  whole.run(go_on);
  MappingSession merged(first, bound.settings);
  merged.stay_open();
  merged.run(go_on);
  const MappingResult& half = merged.result();
  const auto grid = draw_grid_map(half.log, mapped_poses(half), bound.settings.map);
  merged.begin_run(second, place_run(half, *grid, second, bound.settings, {}, go_on));
  merged.run(go_on);

  const RelationsMetric at_once = errors_of(whole.result(), *relations);
  const RelationsMetric in_two = errors_of(merged.result(), *relations);
  std::printf("%s: at once %.4f m %.3f deg, merged %.4f m %.3f deg, largest difference of a pose %.3f m\n",
              name.c_str(), at_once.translation_abs_m.mean, at_once.rotation_abs_deg.mean,
              in_two.translation_abs_m.mean, in_two.rotation_abs_deg.mean,
              largest_difference_m(whole.result(), merged.result()));
  EXPECT_EQ(unjoined_log(merged.result()), std::nullopt);
  EXPECT_EQ(in_two.skipped, at_once.skipped);
  EXPECT_LT(in_two.translation_abs_m.mean, 1.1 * at_once.translation_abs_m.mean);
  EXPECT_LT(in_two.rotation_abs_deg.mean, 1.1 * at_once.rotation_abs_deg.mean);
}

TEST(MergeHalves, of_intel_are_as_good_as_the_whole) {
  merge_halves_of("intel", 100, 2.1);
}

TEST(MergeHalves, of_freiburg_079_are_as_good_as_the_whole) {
  merge_halves_of("fr079", -7, -1.0);
}

}  // namespace
}  // namespace psi_slam
