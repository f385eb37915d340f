// SPDX-License-Identifier: BSD-3-Clause
// A laser whose driver repeats one scan for seconds while the robot drives on by its odometry.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

struct Stall {
  std::string name;
  std::size_t first;  // scan that is repeated
  std::size_t scans;  // that repeat it
  friend void PrintTo(const Stall& stall, std::ostream* out) { *out << stall.name; }
};

/// Reads the scans of a run, of which those of a stall repeat an earlier one.
class StalledReader : public LogReader {
 public:
  StalledReader(const SimulatedRun& run, const Stall& stall)
      : run_(run), first_(stall.first), last_(stall.first + stall.scans) {}
  double progress() const override { return 0; }

 protected:
  std::optional<Frame> read_frame() override {
    if (next_ == run_.truth.size()) return std::nullopt;
    Frame frame;
    frame.time_us = time_us(next_);
    frame.odom_T_robot = run_.odometry[next_];
    frame.scan = run_.scan(next_ > first_ && next_ <= last_ ? first_ : next_);
    ++next_;
    return frame;
  }

 public:
  static TimeUs time_us(std::size_t i) {
    return static_cast<TimeUs>(1e6 * SimulatedRun::kPeriod_s * static_cast<double>(i));
  }

 private:
  const SimulatedRun& run_;
  std::size_t first_;
  std::size_t last_;
  std::size_t next_ = 0;
};

class StalledLaser : public testing::TestWithParam<Stall> {};

TEST_P(StalledLaser, does_not_spoil_the_map) {
  const SimulatedRun run = round_trips(2);
  StalledReader reader(run, GetParam());
  Mapper mapper;
  while (auto frame = reader.next()) mapper.add(*std::move(frame));
  const MappingResult result = mapper.finish();
  double worst_m = 0;
  for (const FrameRecord& frame : result.frames) {
    const auto i = static_cast<std::size_t>(frame.time_us / StalledReader::time_us(1));
    const auto truth = between(run.truth[0], run.truth[i]);
    worst_m = std::max(worst_m, between(truth, frame.map_T_robot).norm());
  }
  EXPECT_LT(worst_m, 0.05);
  EXPECT_TRUE(result.interruptions.empty());
  const std::size_t repeats = run.truth.size() - result.frames.size();
  EXPECT_EQ(repeats, GetParam().scans);
  EXPECT_THAT(reader.assumptions(),
              testing::ElementsAre(testing::StartsWith(std::to_string(repeats) +
                                                       " scans repeat the readings of an earlier scan")));
}

INSTANTIATE_TEST_SUITE_P(Kinds, StalledLaser,
                         testing::Values(Stall{"ahead_for_3_s", 110, 15}, Stall{"ahead_for_5_s", 110, 25},
                                         Stall{"ahead_for_10_s", 110, 50}, Stall{"turning_for_5_s", 190, 25},
                                         Stall{"in_a_corner_for_10_s", 170, 50},
                                         Stall{"in_the_second_round_for_5_s", 500, 25},
                                         Stall{"at_the_start_for_5_s", 0, 25}, Stall{"soon_for_5_s", 2, 25}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace psi_slam
