// SPDX-License-Identifier: BSD-3-Clause
// Compares psi-slam eval with an independent implementation of the same metric. The environment variable
// PSI_SLAM_METRIC_TOOL names a script that takes a trajectory, relations and --json.
#include <gtest/gtest.h>
#include <stdio.h>  // popen

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "app_run.h"
#include "base/number_text.h"
#include "psi_slam/open_log.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Json = nlohmann::json;

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) return {};
  std::string output;
  for (int c = std::fgetc(pipe.get()); c != EOF; c = std::fgetc(pipe.get())) output += static_cast<char>(c);
  return output;
}

std::string quoted(const std::string& path) {
  return '\'' + path + '\'';
}

class MetricTool : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const char* tool = std::getenv("PSI_SLAM_METRIC_TOOL");
    if (tool == nullptr)
      GTEST_SKIP() << "needs PSI_SLAM_METRIC_TOOL, the path of a script that computes the metric";
    tool_ = tool;
    log_ = shared_file(GetParam() + ".clf.gz");
    relations_ = shared_file(GetParam() + ".relations");
    if (!log_ || !relations_) GTEST_SKIP() << kNeedsData;
  }

  /// Writes the odometry of every nth scan as 'timestamp x y theta', with times counted from `origin_us`.
  void write_odometry(std::size_t nth, TimeUs origin_us) const {
    LogOptions options;
    options.every_nth_scan = nth;
    const auto log = open_log(*log_, options);
    std::ofstream file(trajectory_);
    while (const auto frame = log->next()) {
      const auto& pose = frame->odom_T_robot;
      file << format_seconds(frame->time_us - origin_us) << ' ' << fixed_text(pose.x, 9) << ' '
           << fixed_text(pose.y, 9) << ' ' << fixed_text(pose.phi, 9) << '\n';
    }
  }

  /// Writes the relations with times counted from `origin_us`.
  void write_relations(TimeUs origin_us) const {
    std::ifstream from(*relations_);
    std::ofstream to(moved_relations_);
    std::string time1;
    std::string time2;
    std::string rest;
    while (from >> time1 >> time2 && std::getline(from, rest)) {
      to << format_seconds(*parse_seconds(time1) - origin_us) << ' '
         << format_seconds(*parse_seconds(time2) - origin_us) << rest << '\n';
    }
  }

  /// Compares all figures that the tool prints and returns their number.
  std::size_t compare(const std::string& relations, const std::string& max_gap) const {
    const Json theirs = Json::parse(output_of("python3 " + quoted(tool_) + ' ' + quoted(trajectory_) + ' ' +
                                              quoted(relations) + " --json --max-gap " + max_gap));
    const AppRun run = run_app({"eval", trajectory_, relations, "--json", "--max-gap", max_gap});
    EXPECT_EQ(run.code, 0) << run.err;
    const Json ours = Json::parse(run.out);
    std::size_t figures = 0;
    for (const auto& [group, values] : theirs.items()) {
      for (const auto& [name, value] : values.items()) {
        if (!ours.contains(group) || !ours[group].contains(name)) {
          ADD_FAILURE() << "psi-slam eval has no " << group << '.' << name;
          continue;
        }
        const double expected = value;
        EXPECT_NEAR(ours[group][name].get<double>(), expected, 1e-6 * std::max(1.0, std::abs(expected)))
            << group << '.' << name << ", gap " << max_gap;
        ++figures;
      }
    }
    return figures;
  }

  static constexpr std::size_t kFigures = 28;  // 3 counts, and 5 figures of 5 kinds of error
  std::string tool_;
  std::optional<std::filesystem::path> log_;
  std::optional<std::filesystem::path> relations_;
  TemporaryFolder folder_;
  std::string trajectory_ = (folder_.path() / "odometry.txt").string();
  std::string moved_relations_ = (folder_.path() / "moved.relations").string();
};

TEST_P(MetricTool, finds_the_same_in_every_figure) {
  write_odometry(1, 0);
  EXPECT_GE(compare(relations_->string(), "2"), kFigures);
}

// The tool holds times in doubles, which resolve the times of these logs only to 0.1 us. That is too coarse
// to interpolate quick turns to 1e-6, so times are counted from the first scan.
TEST_P(MetricTool, finds_the_same_where_poses_are_interpolated_and_skipped) {
  const TimeUs origin_us = open_log(*log_)->next()->time_us;
  write_odometry(3, origin_us);
  write_relations(origin_us);
  for (const std::string max_gap : {"2", "0.5"}) EXPECT_GE(compare(moved_relations_, max_gap), kFigures);
}

INSTANTIATE_TEST_SUITE_P(all, MetricTool,
                         testing::Values("aces", "intel", "mit-killian", "mit-csail", "fr079"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace psi_slam
