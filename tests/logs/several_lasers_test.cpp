// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_synchronizer.h"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "log_files.h"
#include "psi_slam/user_error.h"
#include "ros1_files.h"
#include "temporary_folder.h"
#include "two_lasers.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;
using Path = std::filesystem::path;

/// Largest distance in metres of a return from the nearest wall, with the frame at its true pose.
double farthest_from_walls_m(const Frame& frame) {
  static const std::vector<Wall> walls = furnished_room();
  double farthest = 0;
  for_each_scan(
      frame, TwoLasers::world_T_robot(frame.time_us), [&](const LaserScan& scan, const TPose2D& pose) {
        for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
          const TPose2D end = pose + scan.robot_T_laser +
                              TPose2D(0, 0, static_cast<double>((*scan.bearings_rad)[i])) +
                              TPose2D(static_cast<double>(scan.ranges_m[i]), 0, 0);
          double nearest = 1e3;
          for (const Wall& wall : walls) {
            const double ex = wall.x2 - wall.x1;
            const double ey = wall.y2 - wall.y1;
            const double along = ((end.x - wall.x1) * ex + (end.y - wall.y1) * ey) / (ex * ex + ey * ey);
            const double share = std::min(1.0, std::max(0.0, along));
            nearest =
                std::min(nearest, std::hypot(wall.x1 + share * ex - end.x, wall.y1 + share * ey - end.y));
          }
          farthest = std::max(farthest, nearest);
        }
      });
  return farthest;
}

struct Kind {
  std::string name;
  std::function<void(const Path&, const TwoLasers&)> write;
  LogOptions options;
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

LogOptions lasers(const std::string& choice, const std::string& mounts = "") {
  LogOptions options;
  options.laser = choice;
  options.laser_mounts = mounts;
  return options;
}

LogOptions topics(const std::string& choice) {
  LogOptions options;
  options.scan_topic = choice;
  return options;
}

const std::string kCarmenMounts = "front 0.3 0.05 0, RLASER -0.4 -0.1 180 mirrored";

std::vector<Kind> kinds() {
  const auto rawlog = [](const Path& path, const TwoLasers& robot) { write_rawlog_of(path, robot); };
  const auto carmen = [](const Path& path, const TwoLasers& robot) { write_carmen_of(path, robot, false); };
  const auto ros1 = [](const Path& path, const TwoLasers& robot) {
    write_ros1_bag(path, recording_of(robot), {"lz4", 7, true});
  };
  const auto mcap = [](const Path& path, const TwoLasers& robot) {
    write_mcap(path, recording_of(robot), {});
  };
  const auto db3 = [](const Path& path, const TwoLasers& robot) { write_db3(path, recording_of(robot)); };
  return {{"rawlog", rawlog, lasers("all")},
          {"rawlog_by_default", rawlog, {}},
          {"carmen_by_default", carmen, lasers("", kCarmenMounts)},
          {"rawlog_by_name", rawlog, lasers("FRONT, REAR")},
          {"carmen", carmen, lasers("all", kCarmenMounts)},
          {"carmen_by_name", carmen, lasers("FLASER,rear", kCarmenMounts)},
          {"ros1", ros1, lasers("all")},
          {"ros2_mcap", mcap, topics("all")},
          {"ros2_db3_by_name", db3, topics("front/scan,/rear/scan")},
          {"ros2_mcap_by_laser", mcap, lasers("/front/scan,/rear/scan")}};
}

class LogOfTwoLasers : public testing::TestWithParam<Kind> {
 protected:
  std::vector<Frame> read(const TwoLasers& robot) {
    GetParam().write(path_, robot);
    return frames_of(path_, GetParam().options);
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "log";
};

TEST_P(LogOfTwoLasers, frames_hold_both_scans_moved_to_one_time) {
  const TwoLasers robot;
  const auto frames = read(robot);
  ASSERT_EQ(frames.size(), 20U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE(i);
    const Frame& frame = frames[i];
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.time_us, TwoLasers::kStart_us + static_cast<TimeUs>(i) * 100'000);
    EXPECT_EQ(frame.scan.laser, 0U);
    EXPECT_NEAR(frame.scan.robot_T_laser.x, 0.3, 1e-6);
    ASSERT_EQ(frame.companions.size(), 1U);
    const CompanionScan& rear = frame.companions[0];
    EXPECT_EQ(rear.scan.laser, 1U);
    EXPECT_EQ(rear.time_us, frame.time_us + 40'000);
    EXPECT_NEAR(rear.scan.robot_T_laser.x, -0.4, 1e-6) << "the mount itself is not moved";
    EXPECT_NEAR(rear.frame_T_robot.phi, 0.04, 2e-4) << "one radian per second";
    EXPECT_GT(rear.scan.bearings_rad->front(), rear.scan.bearings_rad->back()) << "mounted upside down";
    EXPECT_LT(farthest_from_walls_m(frame), 2e-3);
  }
}

TEST_P(LogOfTwoLasers, continues_if_either_laser_is_silent) {
  TwoLasers robot;
  robot.front_silent_from_us = 300'000;
  robot.front_silent_to_us = 900'000;
  robot.rear_silent_from_us = 1'200'000;
  robot.rear_silent_to_us = 1'500'000;
  const auto frames = read(robot);
  std::size_t both = 0, front = 0, rear = 0;
  for (const Frame& frame : frames) {
    EXPECT_LT(farthest_from_walls_m(frame), 2e-3);
    if (!frame.companions.empty())
      ++both;
    else
      ++(frame.scan.laser == 0 ? front : rear);
  }
  // The first rear scan in the gap of the front laser is near a front scan that has a nearer rear scan. The
  // last rear scan in the gap joins the first front scan after the gap. The following rear scans join the
  // next front scans until the rear laser stops.
  EXPECT_EQ(both, 12U);
  EXPECT_EQ(front, 2U);
  EXPECT_EQ(rear, 4U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, LogOfTwoLasers, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param.name; });

class SeveralLasersTest : public testing::Test {
 protected:
  std::string sentence(const LogOptions& options) {
    return sentence_of([&] { frames_of(path_, options); });
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "log";
};

TEST_F(SeveralLasersTest, the_first_laser_named_opens_the_frames) {
  write_rawlog_of(path_, {});
  const auto frames = frames_of(path_, lasers("REAR,FRONT"));
  ASSERT_EQ(frames.size(), 20U);
  EXPECT_EQ(frames[3].time_us, TwoLasers::kStart_us + 340'000);
  EXPECT_NEAR(frames[3].scan.robot_T_laser.x, -0.4, 1e-6);
  ASSERT_EQ(frames[3].companions.size(), 1U);
  EXPECT_EQ(frames[3].companions[0].time_us, TwoLasers::kStart_us + 300'000);
  EXPECT_LT(farthest_from_walls_m(frames[3]), 2e-3);
}

TEST_F(SeveralLasersTest, sweeps_of_both_lasers_are_straightened) {
  TwoLasers robot;
  robot.sweep_us = 60'000;
  write_rawlog_of(path_, robot);
  LogOptions options = lasers("all");
  const auto bent = frames_of(path_, options);
  options.sweep_time_s = 0.06;
  const auto straight = frames_of(path_, options);
  ASSERT_EQ(straight.size(), 20U);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_GT(farthest_from_walls_m(bent[i]), 0.1);
    EXPECT_LT(farthest_from_walls_m(straight[i]), 0.02);
  }
}

TEST_F(SeveralLasersTest, thinned_logs_keep_whole_frames) {
  write_rawlog_of(path_, {});
  LogOptions options = lasers("all");
  options.every_nth_scan = 3;
  const auto frames = frames_of(path_, options);
  ASSERT_EQ(frames.size(), 7U);
  for (const Frame& frame : frames) EXPECT_EQ(frame.companions.size(), 1U);
}

TEST_F(SeveralLasersTest, carmen_parameters_state_the_mounts) {
  write_carmen_of(path_, {}, true);
  const auto frames = frames_of(path_, lasers("all", "RLASER -0.4 -0.1 180 mirrored"));
  EXPECT_NEAR(frames.at(5).scan.robot_T_laser.y, 0.05, 1e-9);
  EXPECT_LT(farthest_from_walls_m(frames.at(5)), 2e-3);
}

TEST_F(SeveralLasersTest, reports_the_laser_without_a_mount) {
  write_carmen_of(path_, {}, false);
  EXPECT_EQ(
      sentence(lasers("all", "FLASER 0.3 0 0")),
      path_.string() +
          " does not state where the laser of its RLASER lines is mounted, which is required to combine "
          "several lasers, expected PARAM robot_rearlaser_offset. State it with log.laser_mounts, such as "
          "\"RLASER 0.2 0 180\" (metres, degrees)");
  EXPECT_EQ(frames_of(path_).size(), 20U) << "a single laser needs no mount";
}

TEST_F(SeveralLasersTest, rejects_two_lasers_with_one_pose) {
  TwoLasers robot;
  write_rawlog(path_, {odometry(1'000'000, {}), range_scan(1'000'000, "A"), range_scan(1'000'000, "B"),
                       odometry(1'100'000, {})});
  EXPECT_THAT(sentence(lasers("all")),
              HasSubstr("the lasers \"A\" and \"B\" have the same pose on the robot"));
  EXPECT_EQ(frames_of(path_, lasers("all", "B -0.3 0 180")).at(0).companions.size(), 1U);
}

TEST_F(SeveralLasersTest, reports_a_missing_laser_with_the_existing_ones) {
  write_carmen_of(path_, {}, true);
  EXPECT_EQ(sentence(lasers("FLASER,RAWLASER3")),
            "log.laser is \"FLASER,RAWLASER3\", but " + path_.string() +
                " has no laser \"RAWLASER3\", expected some of: \"FLASER\", \"RLASER\"");
  EXPECT_EQ(sentence(lasers("front,FLASER")),
            "log.laser is \"front,FLASER\", but \"front\" and \"FLASER\" are the same laser: the FLASER "
            "messages of " +
                path_.string() + ". Name it once");
  write_rawlog_of(path_, {});
  EXPECT_EQ(sentence(lasers("FRONT,LEFT")), "log.laser is \"LEFT\", expected the label of a laser of " +
                                                path_.string() + ": \"FRONT\", \"REAR\"");
  EXPECT_EQ(sentence(lasers("all", "BACK 0 0 0")),
            "log.laser_mounts is \"BACK\", expected the label of a laser of " + path_.string() +
                ": \"FRONT\", \"REAR\"");
  write_mcap(path_, recording_of({}), {});
  EXPECT_EQ(sentence(lasers("/front/scan,/left")),
            "log.laser is \"/left\", expected a topic of type sensor_msgs/LaserScan of " + path_.string() +
                ": /front/scan, /rear/scan");
  EXPECT_EQ(sentence(lasers("/front/scan,front/scan")),
            "log.laser names the topic /front/scan twice. Name each topic once");
}

TEST_F(SeveralLasersTest, a_truncated_log_yields_all_frames_before) {
  write_carmen_of(path_, {}, true);
  std::string log = read_file(path_);
  log.resize(log.size() - 100);
  write_file(path_, log);
  const auto source = open_log(path_, lasers("all"));
  std::size_t frames = 0;
  EXPECT_NE(sentence_of([&] {
              while (source->next()) ++frames;
            }),
            "");
  EXPECT_EQ(frames, 20U);
}

}  // namespace
}  // namespace psi_slam
