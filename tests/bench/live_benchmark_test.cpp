// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_benchmark.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>

#include "../mapping/local_maps/simulated_drive.h"
#include "command_fixture.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

std::vector<Frame> frames_at(const std::vector<TimeUs>& times_us) {
  std::vector<Frame> frames;
  for (const TimeUs time_us : times_us) frames.emplace_back().time_us = time_us;
  return frames;
}

TEST(LiveBenchmark, scans_are_due_at_their_time_stamps_and_long_pauses_are_cut) {
  EXPECT_THAT(due_times_s(frames_at({5'000'000, 5'100'000, 5'050'000, 5'150'000, 99'000'000, 99'500'000})),
              testing::Pointwise(testing::DoubleNear(1e-9), std::vector<double>{0, 0.1, 0.1, 0.2, 2.2, 2.7}));
  EXPECT_TRUE(due_times_s({}).empty());
}

std::vector<Frame> drive() {
  return drive_along(office_floor(), path_along({{1.6, 1.6}, {18.3, 1.6}, {1.6, 1.6}}, 0.16, 0.12),
                     OdometryErrors(), 3)
      .frames;
}

TEST(LiveBenchmark, a_replay_makes_the_map_of_the_log) {
  const Settings settings;
  Mapper mapper(mapper_options(settings));
  std::vector<mrpt::math::TPose2D> live;
  for (const Frame& frame : drive()) live.push_back(mapper.add(frame).map_T_robot);
  const MappingResult result = mapper.finish();
  double share = 0;
  const Replayed replayed = replay(drive(), settings, 0, [&](double now) { share = now; });
  EXPECT_EQ(share, 1);
  ASSERT_EQ(replayed.result.frames.size(), result.frames.size());
  ASSERT_EQ(replayed.latency_ms.size(), result.frames.size());
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    ASSERT_EQ(replayed.result.frames[i].map_T_robot, result.frames[i].map_T_robot) << "scan " << i;
    ASSERT_EQ(replayed.live[i].map_T_robot, live[i]) << "scan " << i;
    ASSERT_GT(replayed.latency_ms[i], 0);
    ASSERT_NEAR(replayed.mapped[i].map_T_robot.x, result.frames[i].map_T_robot.x, 0.2);
    ASSERT_NEAR(replayed.mapped[i].map_T_robot.y, result.frames[i].map_T_robot.y, 0.2);
  }
}

TEST(LiveBenchmark, a_replay_takes_the_time_of_the_log_divided_by_the_speed) {
  const std::vector<Frame> frames = drive();
  const double log_s = due_times_s(frames).back();
  ASSERT_GT(log_s, 5);
  constexpr double kSpeed = 10;
  const auto begin = std::chrono::steady_clock::now();
  replay(frames, Settings(), kSpeed, [](double) {});
  EXPECT_GE(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), log_s / kSpeed);
}

TEST(LiveBenchmark, only_the_last_seconds_are_timed) {
  const std::vector<Frame> frames = drive();
  const std::vector<double> due_s = due_times_s(frames);
  constexpr double kTimed_s = 3;
  const auto timed =
      std::count_if(due_s.begin(), due_s.end(), [&](double due) { return due >= due_s.back() - kTimed_s; });
  constexpr double kSpeed = 10;
  const auto begin = std::chrono::steady_clock::now();
  const Replayed replayed = replay(
      frames, Settings(), kSpeed, [](double) {}, kTimed_s);
  EXPECT_EQ(replayed.latency_ms.size(), static_cast<std::size_t>(timed));
  EXPECT_LT(replayed.latency_ms.size(), frames.size());
  EXPECT_EQ(replayed.live.size(), frames.size());
  EXPECT_GE(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
            kTimed_s / kSpeed * 0.9);
  for (const double latency_ms : replayed.latency_ms) EXPECT_GT(latency_ms, 0);
}

class LiveBenchCommand : public BenchCommand {
 protected:
  LiveBenchCommand() : BenchCommand("live") { write_room(); }
};

TEST_F(LiveBenchCommand, replays_logs_and_simulated_runs_on_each_number_of_processors) {
  const auto json = folder_.path() / "live.json";
  ASSERT_EQ(
      run({"--speeds", "0,100", "--processors", "1", "--simulated-m", "30", "--json", json.string()}, true),
      0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("room"));
  EXPECT_THAT(out_.str(), HasSubstr("as fast as possible"));
  const Json rows = Json::parse(read_file(json))["rows"];
  ASSERT_EQ(rows.size(), 4U);
  for (const Json& row : rows) {
    EXPECT_EQ(row["processors"], 1);
    EXPECT_GT(row["scans"], 20);
    EXPECT_GE(row["latency_ms"]["max"], row["latency_ms"]["p99"]);
    EXPECT_GE(row["latency_ms"]["p99"], row["latency_ms"]["p50"]);
    EXPECT_GT(row["cpu_ms"], 0);
    EXPECT_LT(row["final_m"], 0.3);
    EXPECT_LT(row["live_m"], 0.5);
    EXPECT_LT(row["mapped_m"], 0.5);
  }
  EXPECT_EQ(rows[0]["log"], "room");
  EXPECT_EQ(rows[1]["speed"], 100);
  EXPECT_EQ(rows[2]["log"], "simulated 30 m");
  EXPECT_EQ(rows[0]["final_m"], rows[1]["final_m"]) << "the map does not depend on the speed";
  EXPECT_EQ(rows[0]["live_m"], rows[1]["live_m"]) << "nor do the poses while mapping";
}

TEST_F(LiveBenchCommand, a_stretch_of_a_log_has_no_errors) {
  const auto json = folder_.path() / "live.json";
  ASSERT_EQ(run({"--speeds", "0", "--processors", "1", "--stretch-s", "4", "--json", json.string()}), 0);
  const Json rows = Json::parse(read_file(json))["rows"];
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LE(rows[0]["scans"], 21);
  EXPECT_TRUE(rows[0]["final_m"].is_null());
}

TEST_F(LiveBenchCommand, wrong_usage_gives_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({"--speeds", "-1"}), HasSubstr("--speeds"));
  EXPECT_THAT(refusal({"--logs", "garden"}), HasSubstr("no log called garden"));
  EXPECT_THAT(refusal_of({"live"}), HasSubstr("--data"));
}

}  // namespace
}  // namespace psi_slam
