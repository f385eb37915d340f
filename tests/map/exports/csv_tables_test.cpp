// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/csv_tables.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "pose_graph/shared_errors.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  if (!line.empty() && line.back() == ',') fields.emplace_back();
  return fields;
}

TEST(TrajectoryCsv, has_a_pose_with_its_covariance_for_each_scan) {
  const MappingResult result = walk_around_the_room();
  const std::vector<Eigen::Matrix3d> covariances = pose_covariances(result.graph);
  std::istringstream text(trajectory_csv(result));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line,
            "time_s,x_m,y_m,theta_rad,cov_xx_m2,cov_xy_m2,cov_xtheta_m_rad,cov_yy_m2,cov_ytheta_m_rad,"
            "cov_thetatheta_rad2,run");
  std::size_t node = 0;
  for (const FrameRecord& frame : result.frames) {
    node = frame.node.value_or(node);
    ASSERT_TRUE(std::getline(text, line));
    const std::vector<std::string> fields = split(line);
    ASSERT_EQ(fields.size(), 11U);
    EXPECT_NEAR(std::stod(fields[1]), frame.map_T_robot.x, 1e-6);
    EXPECT_NEAR(std::stod(fields[4]), covariances[node](0, 0), 1e-10);
    EXPECT_NEAR(std::stod(fields[6]), covariances[node](0, 2), 1e-10);
    EXPECT_NEAR(std::stod(fields[7]), covariances[node](1, 1), 1e-10);
    EXPECT_NEAR(std::stod(fields[9]), covariances[node](2, 2), 1e-10);
    EXPECT_EQ(fields[10], "1");
  }
  EXPECT_FALSE(std::getline(text, line));
  EXPECT_GT(covariances.back()(0, 0), 0);
}

TEST(TrajectoryCsv, has_empty_covariances_in_a_run_that_was_never_placed) {
  MappingResult result = walk_around_the_room();
  const std::size_t lost = result.node_frames.size() - 1;
  for (const std::uint32_t i : result.graph.constraints_of(lost)) result.graph.set_enabled(i, false);
  result.later_run_frames = {result.node_frames[lost]};
  std::istringstream text(trajectory_csv(result));
  std::string line;
  std::getline(text, line);
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    ASSERT_TRUE(std::getline(text, line));
    const std::vector<std::string> fields = split(line);
    ASSERT_EQ(fields.size(), 11U);
    const bool is_lost = i >= result.node_frames[lost];
    for (std::size_t column = 4; column < 10; ++column) EXPECT_EQ(fields[column].empty(), is_lost) << i;
    EXPECT_EQ(fields[10], is_lost ? "2" : "1");
  }
}

TEST(FramesCsv, has_one_row_per_scan_below_the_header) {
  const MappingResult result = walk_around_the_room();
  std::istringstream text(frames_csv(result.frames));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> header = split(line);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  for (const FrameRecord& frame : result.frames) {
    ASSERT_TRUE(std::getline(text, line));
    const std::vector<std::string> row = split(line);
    ASSERT_EQ(row.size(), header.size());
    EXPECT_EQ(row[column("time_s")], format_seconds(frame.time_us));
    EXPECT_NEAR(std::stod(row[column("map_x_m")]), frame.map_T_robot.x, 1e-6);
    EXPECT_NEAR(std::stod(row[column("odom_theta_rad")]), frame.odom_T_robot.phi, 1e-6);
    EXPECT_NEAR(std::stod(row[column("response")]), frame.response, 1e-4);
    EXPECT_EQ(row[column("node")], frame.node ? std::to_string(*frame.node) : "");
    EXPECT_EQ(row[column("matcher")], frame.matcher ? name(*frame.matcher) : "");
    EXPECT_EQ(std::stoll(row[column("evaluations")]), frame.evaluations);
    EXPECT_EQ(std::stoll(row[column("loop_evaluations")]), frame.loop_evaluations);
    EXPECT_NEAR(std::stod(row[column("psi")]), frame.psi, 1e-4);
    EXPECT_NEAR(std::stod(row[column("eta")]), frame.eta, 1e-4);
    EXPECT_NEAR(std::stod(row[column("mean_loops")]), frame.mean_loops, 1e-4);
    EXPECT_NEAR(std::stod(row[column("loop_matching_ms")]), frame.loop_matching_ms, 1e-4);
    EXPECT_EQ(row[column("matched")], &frame == &result.frames.front() ? "" : "1");
    EXPECT_EQ(row[column("searched_loops")], frame.node ? "1" : "0");
    EXPECT_EQ(row[column("branch_and_bound_searches")], frame.matcher == MatcherKind::kCsm ? "1" : "0");
    EXPECT_EQ(row[column("local_searches")], frame.matcher && frame.matcher != MatcherKind::kCsm ? "1" : "0");
    EXPECT_EQ(row[column("genetic_searches")], "0");
  }
  EXPECT_FALSE(std::getline(text, line));
}

TEST(FramesCsv, tells_unmatched_scans_from_those_without_a_map_to_match_with) {
  std::vector<FrameRecord> frames(3);
  frames[1].match = ScanMatch::kMatched;
  frames[2].match = ScanMatch::kUnmatched;
  std::istringstream text(frames_csv(frames));
  std::string line;
  for (const char* expected : {"matched", "", "1", "0"}) {
    ASSERT_TRUE(std::getline(text, line));
    const std::vector<std::string> row = split(line);
    EXPECT_EQ(row.at(row.size() - 2 - kSearchKinds.size()), expected);
  }
}

TEST(LoopsCsv, has_one_row_per_attempt_with_state_and_reason) {
  const MappingResult result = walk_around_the_room();
  std::istringstream text(loops_csv(result.loops));
  std::string header;
  std::string rejected;
  std::string accepted;
  std::getline(text, header);
  std::getline(text, rejected);
  std::getline(text, accepted);
  EXPECT_THAT(
      header,
      StartsWith("frame,node,local_map,anchor,state,reason,matcher,in_last_pass,by_hand,x_m,y_m,theta_rad,"));
  EXPECT_THAT(rejected,
              StartsWith("25,5,0,0,rejected,\"the response is too low: 0.41, minimum 0.55\",csm,0,0,"));
  EXPECT_THAT(accepted, StartsWith("45,9,0,0,accepted,,csm,0,0,"));
  EXPECT_THAT(accepted, HasSubstr(",0.010000,0.010000,0.010000,"));
  EXPECT_THAT(header, EndsWith(",milliseconds,search"));
  EXPECT_THAT(accepted, EndsWith(",branch_and_bound"));
  EXPECT_THAT(rejected, EndsWith(",exhaustive"));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(accepted.begin(), accepted.end(), ','));
  EXPECT_FALSE(std::getline(text, header));
}

TEST(CsvField, quotes_separators_and_quotes_only) {
  EXPECT_EQ(csv_field("plain text"), "plain text");
  EXPECT_EQ(csv_field("a,\"b\""), "\"a,\"\"b\"\"\"");
}

}  // namespace
}  // namespace psi_slam
