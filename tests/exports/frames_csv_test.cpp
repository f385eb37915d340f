// SPDX-License-Identifier: BSD-3-Clause
#include "exports/frames_csv.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "simulated_room.h"

namespace psi_slam {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

TEST(FramesCsv, has_a_row_for_each_scan_under_its_header) {
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
  }
  EXPECT_FALSE(std::getline(text, line));
}

}  // namespace
}  // namespace psi_slam
