// SPDX-License-Identifier: BSD-3-Clause
// Logs that state absurd numbers. psi-slam must map each or refuse it with one sentence. It must not crash,
// hang or take more than 2 GiB of memory.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

#include "../session/room_log.h"
#include "app_run.h"
#include "rawlog_files.h"
#include "ros1_files.h"
#include "sanitizer.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::MatchesRegex;

constexpr int kScans = 40;
const float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Writes a log at the path.
using Write = std::function<void(const fs::path& path)>;

struct AbsurdLog {
  std::string name;
  Write write;
  friend void PrintTo(const AbsurdLog& log, std::ostream* out) { *out << log.name; }
};

class AbsurdLogs : public testing::TestWithParam<AbsurdLog> {};

AppRun run_within_limits(const std::vector<std::string>& arguments, const fs::path& folder) {
  const AppProcess process(arguments, folder, [] {
    const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30};
    if (!kHasAddressSanitizer) ::setrlimit(RLIMIT_AS, &memory);
    const rlimit time_s{60, 60};  // of the processor: ends a program that hangs
    ::setrlimit(RLIMIT_CPU, &time_s);
  });
  return process.finish();
}

void expect_result_or_sentence(const AppRun& run) {
  EXPECT_THAT(run.code, AnyOf(0, 2)) << run.err;
  if (run.code == 2) {
    EXPECT_THAT(run.err, MatchesRegex("psi-slam: [^\n]+\n")) << "one sentence";
  }
}

TEST_P(AbsurdLogs, are_mapped_or_refused_with_one_sentence) {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "absurd.log";
  GetParam().write(log);
  const std::string out = (folder.path() / "out").string();
  const AppRun map = run_within_limits({log.string(), "-o", out}, folder.path());
  RecordProperty("message", map.err);
  expect_result_or_sentence(map);
  expect_result_or_sentence(run_within_limits({"check", log.string()}, folder.path()));
}

std::string absurd_name(const testing::TestParamInfo<AbsurdLog>& absurd) {
  return absurd.param.name;
}

// ---- CARMEN ----

/// Positions of the words in a FLASER line.
enum Word : std::size_t {
  kX = 2 + kRoomBeams + 3,  // of the odometry
  kY,
  kTheta,
  kTime,
};

using Words = std::vector<std::string>;

/// A log of the room whose lines `change` has changed.
AbsurdLog carmen(const std::string& name, const std::function<void(int scan, Words& words)>& change,
                 const std::string& head = "") {
  return {name, [=](const fs::path& path) {
            std::vector<std::string> lines{head};
            const std::vector<std::string> sane = room_log_lines(kScans, 50);
            for (int i = 0; i < kScans; ++i) {
              Words words = words_of(sane[static_cast<std::size_t>(i)]);
              change(i, words);
              std::string line;
              for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
              lines.push_back(line);
            }
            write_lines(path, lines);
          }};
}

AbsurdLog carmen_with(const std::string& name, Word word, const std::function<std::string(int scan)>& value) {
  return carmen(name, [=](int scan, Words& words) { words.at(word) = value(scan); });
}

void set_ranges(Words& words, const std::string& range) {
  std::fill(words.begin() + 2, words.begin() + 2 + kRoomBeams, range);
}

/// From scan 20 on, odometry is `jump` metres farther, and the scans see nothing that they saw before.
AbsurdLog jump_to_another_room(const std::string& name, double jump_m) {
  return carmen(name, [=](int scan, Words& words) {
    if (scan < 20) return;
    words[kX] = std::to_string(jump_m);
    for (std::size_t i = 2; i < 2 + kRoomBeams; ++i) words[i] = i % 40 < 20 ? "1.5" : "2.5";
  });
}

std::string raw_laser(double start_rad, double field_rad, double step_rad, double max_m, int scan) {
  std::ostringstream line;
  line << "RAWLASER1 0 " << start_rad << ' ' << field_rad << ' ' << step_rad << ' ' << max_m << " 0.01 0 9";
  for (int beam = 0; beam < 9; ++beam) line << ' ' << 2 + 0.1 * beam;
  line << " 0 " << 10 + scan << " host 1\n";
  return line.str();
}

AbsurdLog raw_lasers(const std::string& name, double start_rad, double field_rad, double step_rad,
                     double max_m) {
  return {name, [=](const fs::path& path) {
            std::string log;
            for (int scan = 0; scan < kScans; ++scan)
              log += raw_laser(start_rad, field_rad, step_rad, max_m, scan);
            write_bytes(path, log);
          }};
}

AbsurdLog many_beams(const std::string& name, int beams, int scans) {
  return {name, [=](const fs::path& path) {
            std::string log;
            for (int scan = 0; scan < scans; ++scan) {
              log += "RAWLASER1 0 -1.57 3.14 0 30 0.01 0 " + std::to_string(beams);
              for (int beam = 0; beam < beams; ++beam) log += " 2";
              log += " 0 " + std::to_string(10 + scan) + " host 1\n";
            }
            write_bytes(path, log);
          }};
}

const std::vector<AbsurdLog> kCarmen{
    carmen_with("odometry_jumps_by_1e300_m", kX, [](int scan) { return scan < 20 ? "0" : "1e300"; }),
    carmen_with("odometry_jumps_by_1e9_m", kX, [](int scan) { return scan < 20 ? "0" : "1e9"; }),
    carmen_with("odometry_jumps_by_9e6_m", kX, [](int scan) { return scan < 20 ? "0" : "9e6"; }),
    carmen_with("odometry_jumps_to_and_fro", kX, [](int scan) { return scan % 2 == 0 ? "0" : "-9e6"; }),
    carmen_with("odometry_drives_at_2_km_per_s", kX, [](int scan) { return std::to_string(400 * scan); }),
    carmen_with("odometry_is_nan", kX, [](int) { return "nan"; }),
    carmen_with("odometry_is_nan_once", kX, [](int scan) { return scan == 20 ? "nan" : "0"; }),
    carmen_with("odometry_is_far_away", kX, [](int scan) { return std::to_string(5e6 + 0.1 * scan); }),
    carmen_with("headings_of_1e300", kTheta, [](int scan) { return scan % 2 == 0 ? "1e300" : "-1e300"; }),
    jump_to_another_room("another_room_at_9e6_m", 9e6),
    jump_to_another_room("another_room_at_900_m", 900),
    carmen("jumps_of_900_m_without_returns",
           [](int scan, Words& words) {
             words[kX] = std::to_string(900 * scan);
             words[kY] = std::to_string(800 * scan);
             if (scan > 0) set_ranges(words, "81.83");
           }),
    carmen_with("stamps_in_milliseconds", kTime,
                [](int scan) { return std::to_string(1'700'000'000'000 + 200 * scan); }),
    carmen_with("stamps_in_nanoseconds", kTime,
                [](int scan) { return std::to_string(1'700'000'000'000'000'000 + 200'000'000L * scan); }),
    carmen_with("stamps_of_zero", kTime, [](int) { return "0"; }),
    carmen_with("stamps_of_the_year_3000", kTime,
                [](int scan) { return std::to_string(32'503'680'000 + scan); }),
    carmen_with("stamps_jump_to_the_year_3000", kTime,
                [](int scan) { return std::to_string((scan < 20 ? 0 : 32'503'680'000) + scan); }),
    carmen_with("stamps_from_end_to_end", kTime,
                [](int scan) { return scan % 2 == 0 ? "-3.9e12" : "3.9e12"; }),
    carmen("ranges_of_1e30", [](int, Words& words) { set_ranges(words, "1e30"); }),
    carmen(
        "ranges_of_1e30_within_the_maximum",
        [](int scan, Words& words) { words[static_cast<std::size_t>(2 + scan)] = "1e30"; },
        "PARAM robot_front_laser_max 1e35"),
    carmen(
        "ranges_of_1e300",
        [](int scan, Words& words) { words[static_cast<std::size_t>(2 + scan)] = "1e300"; },
        "PARAM robot_front_laser_max 1e300"),
    carmen("ranges_are_nan", [](int, Words& words) { set_ranges(words, "nan"); }),
    carmen("everything_is_nan", [](int, Words& words) { std::fill(words.begin() + 2, words.end(), "nan"); }),
    carmen(
        "a_laser_1e9_m_ahead", [](int, Words&) {}, "PARAM robot_frontlaser_offset 1e9"),
    carmen(
        "a_laser_1e300_m_to_the_left", [](int, Words&) {}, "PARAM robot_frontlaser_side_offset 1e300"),
    carmen(
        "a_laser_turned_by_1e300", [](int, Words&) {}, "PARAM robot_frontlaser_angular_offset 1e300"),
    carmen(
        "a_resolution_of_1e9_degrees", [](int, Words& words) { words[1] = "181"; },
        "PARAM laser_front_laser_resolution 1e9"),
    carmen("a_count_of_10_million_beams", [](int, Words& words) { words[1] = "10000000"; }),
    raw_lasers("bearings_from_1e9_on", 1e9, 3, 0, 30),
    raw_lasers("bearings_in_degrees", -90, 180, 1, 30),
    raw_lasers("bearings_with_steps_of_1e300", 0, 0, 1e300, 30),
    raw_lasers("a_maximum_range_of_1e300", -1, 2, 0, 1e300),
    many_beams("lines_of_10_million_beams", 10'000'000, 1),
    many_beams("scans_of_100000_beams", 100'000, 10),
};

INSTANTIATE_TEST_SUITE_P(Carmen, AbsurdLogs, testing::ValuesIn(kCarmen), absurd_name);

// ---- Bags ----

AbsurdLog bag(
    const std::string& name, const std::function<void(int scan, RecordedScan& scan_message)>& change,
    const std::function<void(int scan, RecordedPose& odometry)>& move = [](int, RecordedPose&) {},
    const mrpt::math::TPose3D& mount = {0.2, 0, 0.4, 0.3, 0, 0}) {
  return {name, [=](const fs::path& path) {
            constexpr TimeUs kStart_us = 1'600'000'000'000'000;
            Recording recording{static_mount("laser", mount)};
            for (int i = 0; i < kScans; ++i) {
              const mrpt::math::TPose2D pose = room_pose(2 * M_PI * i / 50);
              RecordedPose odometry{
                  "/odom", kStart_us + 200'000 * i, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}};
              move(i, odometry);
              recording.emplace_back(odometry);
              RecordedScan scan;
              scan.time_us = kStart_us + 200'000 * i;
              scan.angle_min_rad = static_cast<float>(-M_PI / 2);
              scan.angle_increment_rad = static_cast<float>(M_PI / 180);
              scan.ranges_m.clear();
              for (int beam = 0; beam < kRoomBeams; ++beam)
                scan.ranges_m.push_back(
                    static_cast<float>(room_range_m(pose.x, pose.y, pose.phi + M_PI * (beam - 90) / 180)));
              change(i, scan);
              recording.emplace_back(scan);
            }
            write_ros1_bag(path, recording);
          }};
}

const std::vector<AbsurdLog> kBags{
    bag("steps_of_1e6_radians", [](int, RecordedScan& scan) { scan.angle_increment_rad = 1e6F; }),
    bag("steps_of_one_degree_as_radians", [](int, RecordedScan& scan) { scan.angle_increment_rad = 1; }),
    bag("steps_are_nan", [](int, RecordedScan& scan) { scan.angle_increment_rad = kNaN; }),
    bag("a_first_bearing_of_1e30", [](int, RecordedScan& scan) { scan.angle_min_rad = 1e30F; }),
    bag("ten_million_beams",
        [](int i, RecordedScan& scan) {
          if (i == 20) scan.ranges_m.assign(10'000'000, 2);
        }),
    bag("ranges_of_1e30",
        [](int i, RecordedScan& scan) {
          scan.range_max_m = 1e35F;
          scan.ranges_m.at(static_cast<std::size_t>(i)) = 1e30F;
        }),
    bag("limits_and_ranges_are_nan",
        [](int i, RecordedScan& scan) {
          scan.range_min_m = scan.range_max_m = scan.scan_time_s = scan.time_increment_s = kNaN;
          scan.ranges_m.at(static_cast<std::size_t>(i)) = kNaN;
        }),
    bag("sweeps_of_1e30_s",
        [](int, RecordedScan& scan) { scan.time_increment_s = scan.scan_time_s = 1e30F; }),
    bag("stamps_of_zero", [](int, RecordedScan& scan) { scan.time_us = 0; }),
    bag(
        "odometry_jumps_by_1e9_m", [](int, RecordedScan&) {},
        [](int i, RecordedPose& odometry) { odometry.pose.x += i < 20 ? 0 : 1e9; }),
    bag(
        "odometry_jumps_by_9e6_m_to_and_fro", [](int, RecordedScan&) {},
        [](int i, RecordedPose& odometry) { odometry.pose.x += i % 2 == 0 ? 0 : 9e6; }),
    bag(
        "odometry_is_nan", [](int, RecordedScan&) {},
        [](int, RecordedPose& odometry) { odometry.pose.x = std::nan(""); }),
    bag(
        "odometry_in_the_year_2100", [](int, RecordedScan&) {},
        [](int, RecordedPose& odometry) { odometry.time_us += 2'500'000'000'000'000; }),
    bag(
        "a_laser_1e7_m_ahead", [](int, RecordedScan&) {}, [](int, RecordedPose&) {}, {1e7, 0, 0, 0, 0, 0}),
    bag(
        "a_laser_at_nan", [](int, RecordedScan&) {}, [](int, RecordedPose&) {},
        {std::nan(""), 0, 0, 0, 0, 0}),
};

INSTANTIATE_TEST_SUITE_P(Bag, AbsurdLogs, testing::ValuesIn(kBags), absurd_name);

// ---- Rawlogs ----

using Scan = mrpt::obs::CObservation2DRangeScan;

AbsurdLog rawlog(
    const std::string& name, const std::function<void(int scan, Scan& observation)>& change,
    const std::function<void(int scan, mrpt::poses::CPose2D& pose)>& move = [](int, mrpt::poses::CPose2D&) {
    }) {
  return {name, [=](const fs::path& path) {
            RawlogObjects objects;
            for (int i = 0; i < kScans; ++i) {
              const TimeUs time_us = 1'600'000'000'000'000 + 200'000 * i;
              mrpt::poses::CPose2D pose(0.1 * i, 0, 0);
              move(i, pose);
              objects.push_back(odometry(time_us, pose));
              std::vector<float> ranges_m(181);
              for (std::size_t beam = 0; beam < ranges_m.size(); ++beam)
                ranges_m[beam] = static_cast<float>(
                    room_range_m(2 + 0.1 * i, 2, M_PI * (static_cast<double>(beam) - 90) / 180));
              const auto observation = range_scan(time_us, "LASER", ranges_m);
              observation->aperture = static_cast<float>(M_PI);
              change(i, *observation);
              objects.push_back(observation);
            }
            write_rawlog(path, objects, false);
          }};
}

const std::vector<AbsurdLog> kRawlogs{
    rawlog("an_aperture_of_1e30", [](int, Scan& scan) { scan.aperture = 1e30F; }),
    rawlog("an_aperture_of_nan", [](int, Scan& scan) { scan.aperture = kNaN; }),
    rawlog("an_aperture_of_zero", [](int, Scan& scan) { scan.aperture = 0; }),
    rawlog("ranges_of_1e30",
           [](int i, Scan& scan) {
             scan.maxRange = 1e35F;
             scan.setScanRange(static_cast<std::size_t>(i), 1e30F);
           }),
    rawlog("limits_and_ranges_are_nan",
           [](int i, Scan& scan) {
             scan.maxRange = kNaN;
             scan.setScanRange(static_cast<std::size_t>(i), kNaN);
           }),
    rawlog("ten_million_beams",
           [](int i, Scan& scan) {
             if (i == 20) scan.resizeScanAndAssign(10'000'000, 2, true);
           }),
    rawlog("a_laser_1e9_m_ahead", [](int, Scan& scan) { scan.sensorPose.x(1e9); }),
    rawlog("a_laser_at_nan", [](int, Scan& scan) { scan.sensorPose.x(std::nan("")); }),
    rawlog("a_laser_turned_by_nan",
           [](int, Scan& scan) { scan.sensorPose.setYawPitchRoll(std::nan(""), 0, 0); }),
    rawlog("stamps_of_the_year_3000",
           [](int i, Scan& scan) { scan.timestamp = mrpt_time(32'503'680'000'000'000 + 200'000 * i); }),
    rawlog(
        "odometry_jumps_by_1e9_m", [](int, Scan&) {},
        [](int i, mrpt::poses::CPose2D& pose) { pose.x(i < 20 ? 0 : 1e9); }),
    rawlog(
        "odometry_jumps_by_9e6_m", [](int, Scan&) {},
        [](int i, mrpt::poses::CPose2D& pose) { pose.x(i < 20 ? 0 : 9e6); }),
    rawlog(
        "odometry_is_nan", [](int, Scan&) {}, [](int, mrpt::poses::CPose2D& pose) { pose.x(std::nan("")); }),
};

INSTANTIATE_TEST_SUITE_P(Rawlog, AbsurdLogs, testing::ValuesIn(kRawlogs), absurd_name);

}  // namespace
}  // namespace psi_slam
