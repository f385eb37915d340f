// SPDX-License-Identifier: BSD-3-Clause
// Recordings with one fault each, whose maps are compared with the true path.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app_run.h"
#include "base/compression/line_reader.h"
#include "path_error.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

struct FaultyLog {
  std::string file;   // in the folder faults
  std::string truth;  // file beside it
  double max_error_m = 0;
  std::string sentence;                  // part of what psi-slam prints; empty: prints nothing
  std::vector<std::string> arguments{};  // besides the log and the output folder
  friend void PrintTo(const FaultyLog& log, std::ostream* out) { *out << log.file; }
};

std::string name_of_test(const std::string& file, std::size_t index) {
  std::string name = file.substr(0, file.find('.'));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(c) == 0; }, '_');
  return name + "_" + std::to_string(index);
}

class RecordedFault : public testing::TestWithParam<FaultyLog> {};

TEST_P(RecordedFault, does_not_spoil_the_map) {
  const auto log = shared_file("faults/" + GetParam().file);
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "map";
  std::vector<std::string> arguments{log->string(), "-o", out.string(), "-q"};
  arguments.insert(arguments.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const AppRun run = run_app(arguments);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LE(path_error_m(out / "trajectory.tum", log->parent_path() / GetParam().truth),
            GetParam().max_error_m);
  if (GetParam().sentence.empty()) {
    EXPECT_EQ(run.err, "");
  } else {
    EXPECT_THAT(run.err, HasSubstr(GetParam().sentence));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, RecordedFault,
    testing::Values(
        FaultyLog{"one_bad_scan.db3.zstd", "small.tum", 0.02, "1 message of the log is unusable"},
        FaultyLog{"two_robots.db3.zstd", "robot2.tum", 0.016, "", {"--set", "log.scan_topic=/robot2/scan"}},
        FaultyLog{"stall_a.clf.gz", "stall.tum", 0.01, "18 scans repeat the readings of an earlier scan"},
        FaultyLog{"stall_none.clf.gz", "stall.tum", 0.01, ""},
        FaultyLog{"published_twice.db3.zstd", "small.tum", 0.01,
                  "scans repeat the readings of an earlier scan"},
        FaultyLog{"laser_backwards.db3.zstd", "laser_backwards.tum", 0.012,
                  "not at yaw 0.00 degrees as read from the log; this pose is used"},
        FaultyLog{"first_scan_bad.db3.zstd", "small.tum", 0.02, "1 message of the log is unusable"}),
    [](const auto& tested) { return name_of_test(tested.param.file, tested.index); });

// Odometry of a recorded robot freezes for eight seconds, and its laser sees 5.6 m far. The map with the
// whole odometry is the truth.
TEST(RecordedFaults, frozen_odometry_does_not_bend_the_map) {
  const auto log = shared_file("mit-csail.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  constexpr int kFirst = 1400;
  constexpr int kFrozen = 1600;
  constexpr int kLast = 1640;
  constexpr double kRange_m = 5.6;
  const TemporaryFolder folder;
  std::ofstream whole(folder.path() / "whole.clf");
  std::ofstream frozen(folder.path() / "frozen.clf");
  LineReader lines(*log);
  std::vector<std::string> last_poses;
  int scan = 0;
  for (std::string_view line; lines.next(line);) {
    std::istringstream words{std::string(line)};
    std::string tag;
    std::size_t beams = 0;
    if (!(words >> tag >> beams) || tag != "FLASER" || ++scan < kFirst || scan > kLast) continue;
    std::ostringstream ranges;
    double range_m = 0;
    for (std::size_t i = 0; i < beams && words >> range_m; ++i) ranges << ' ' << std::min(range_m, kRange_m);
    std::vector<std::string> poses(6);
    for (std::string& value : poses) words >> value;
    if (scan <= kFrozen) last_poses = poses;
    std::string rest;
    std::getline(words, rest);
    for (auto& [out, values] : {std::pair(&whole, &poses), std::pair(&frozen, &last_poses)}) {
      *out << "FLASER " << beams << ranges.str();
      for (const std::string& value : *values) *out << ' ' << value;
      *out << rest << '\n';
    }
  }
  whole.close();
  frozen.close();
  for (const char* name : {"whole", "frozen"}) {
    const AppRun run =
        run_app({(folder.path() / name).string() + ".clf", "-o", (folder.path() / name).string(), "-q"});
    ASSERT_EQ(run.code, 0) << run.err;
    const bool is_said = run.err.find("odometry did not change in ") != std::string::npos;
    EXPECT_EQ(is_said, name == std::string("frozen")) << run.err;
  }
  EXPECT_LT(
      path_error_m(folder.path() / "frozen" / "trajectory.tum", folder.path() / "whole" / "trajectory.tum"),
      0.1);
}

struct JudgedLog {
  std::string file;               // in the folder faults
  std::vector<std::string> says;  // parts of what psi-slam check prints
  std::vector<std::string> omits{};
  friend void PrintTo(const JudgedLog& log, std::ostream* out) { *out << log.file; }
};

class JudgedFault : public testing::TestWithParam<JudgedLog> {};

TEST_P(JudgedFault, gets_the_right_advice) {
  const auto log = shared_file("faults/" + GetParam().file);
  if (!log) GTEST_SKIP() << kNeedsData;
  const AppRun run = run_app({"check", log->string()});
  EXPECT_EQ(run.code, 0) << run.err;
  for (const std::string& part : GetParam().says) EXPECT_THAT(run.out, HasSubstr(part));
  for (const std::string& part : GetParam().omits) EXPECT_THAT(run.out, Not(HasSubstr(part)));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, JudgedFault,
    testing::Values(
        JudgedLog{"stall_a.clf.gz", {"18 scans repeat the readings of an earlier scan"}, {"second pose"}},
        JudgedLog{"stall_none.clf.gz", {}, {"repeat", "second pose"}},
        JudgedLog{"published_twice.db3.zstd", {"scans repeat the readings"}, {"unrelated", "odometry's"}},
        JudgedLog{"offset_+1.3s.db3.zstd",
                  {"the stamps of scans and odometry differ by ", "log.scan_delay_s = "},
                  {"degrees, not", "feet", "does not change"}},
        JudgedLog{"offset_-2.0s.db3.zstd",
                  {"the stamps of scans and odometry differ by ", "log.scan_delay_s = -"},
                  {"degrees, not", "feet", "does not change"}},
        JudgedLog{"beam_count_varies.db3.zstd", {}, {"odometry's", "feet", "metres"}},
        JudgedLog{"wrong_fov.log.gz",
                  {"field of view of 180 degrees, not 90", "log.field_of_view_deg = 180"},
                  {"degrees, not radians"}},
        JudgedLog{"right_fov.log.gz", {"verdict: ready to map"}},
        JudgedLog{"laser_backwards.db3.zstd",
                  {"as if the laser were at x ", "log.laser_yaw_deg = "},
                  {"reversing"}},
        JudgedLog{"thinned_pause.log.gz", {"verdict: ready to map"}, {"clock"}}),
    [](const auto& tested) { return name_of_test(tested.param.file, tested.index); });

constexpr double kTruthBegins_s = 1'700'000'000;  // time stamp of the first pose in small.tum

// The robot is blocked and turned by 26 degrees in each of four scans, while odometry drives straight on.
TEST(RecordedFaults, a_collision_with_turning_wheels_does_not_turn_the_map) {
  const auto log = shared_file("faults/collision26.log.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "map";
  const AppRun run = run_app({log->string(), "-o", out.string(), "-q"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  const Trajectory path = read_trajectory(out / "trajectory.tum");
  ASSERT_EQ(path.size(), 44U);
  for (std::size_t i = 0; i < 22; ++i) {  // until the robot turns by itself
    const double turns = std::clamp(static_cast<double>(i) - 11, 0.0, 4.0);
    EXPECT_NEAR(path[i].pose.phi, -26 * M_PI / 180 * turns, 0.02) << "scan " << i;
  }
}

TEST(RecordedFaults, the_advised_delay_removes_an_offset_of_clocks) {
  for (const auto& [file, delay_s] :
       {std::pair("offset_+1.3s.db3.zstd", 1.3), std::pair("offset_-2.0s.db3.zstd", -2.0)}) {
    const auto log = shared_file(std::string("faults/") + file);
    if (!log) GTEST_SKIP() << kNeedsData;
    const std::string checked = run_app({"check", log->string()}).out;
    const std::string option = "log.scan_delay_s = ";
    const std::size_t at = checked.find(option);
    ASSERT_NE(at, std::string::npos) << checked;
    const std::string advised =
        checked.substr(at + option.size(), checked.find('\n', at) - at - option.size());
    EXPECT_NEAR(std::stod(advised), delay_s, 0.02);
    const TemporaryFolder folder;
    const AppRun run = run_app({log->string(), "-o", (folder.path() / "map").string(), "-q", "--set",
                                "log.scan_delay_s=" + advised});
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    std::ifstream mapped(folder.path() / "map" / "trajectory.tum");
    std::ofstream true_times(folder.path() / "true_times.tum");
    double stamp_s = 0;
    std::string pose;
    while (mapped >> stamp_s && std::getline(mapped, pose))
      if (stamp_s - delay_s >= kTruthBegins_s) true_times << std::fixed << stamp_s - delay_s << pose << '\n';
    true_times.close();
    EXPECT_LE(path_error_m(folder.path() / "true_times.tum", log->parent_path() / "small.tum"), 0.02) << file;
  }
}

TEST(RecordedFaults, a_wrong_field_of_view_gives_the_map_of_the_right_one) {
  const auto wrong = shared_file("faults/wrong_fov.log.gz");
  const auto right = shared_file("faults/right_fov.log.gz");
  if (!wrong || !right) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const auto map = [&](const fs::path& log, const char* name, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{log.string(), "-o", (folder.path() / name).string(), "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_app(arguments).err;
  };
  EXPECT_THAT(map(*wrong, "wrong"), HasSubstr("a field of view of 180 degrees, not 90 as the log states"));
  EXPECT_EQ(map(*right, "right"), "");
  EXPECT_LE(
      path_error_m(folder.path() / "wrong" / "trajectory.tum", folder.path() / "right" / "trajectory.tum"),
      0.03);
  EXPECT_THAT(map(*wrong, "stated", {"--set", "log.field_of_view_deg=90"}), Not(HasSubstr("it is used")));
}

/// A map as psi-slam writes it, of a log that begins at (1.7, 1.5) m in the simulated room.
class MapOfRoom {
 public:
  explicit MapOfRoom(const fs::path& folder) {
    std::ifstream yaml(folder / "map.yaml");
    for (std::string word; yaml >> word;)
      if (word == "resolution:")
        yaml >> resolution_m_;
      else if (word == "origin:")
        yaml.ignore(2) >> x_min_, yaml.ignore(1) >> y_min_;
    std::ifstream pgm(folder / "map.pgm", std::ios::binary);
    std::string magic;
    int most = 0;
    pgm >> magic >> width_ >> height_ >> most;
    pgm.ignore(1);
    pixels_.assign(std::istreambuf_iterator<char>(pgm), {});
  }

  /// Share of the points of a line that have an obstacle within 0.1 m.
  double drawn(double x, double y, double to_x, double to_y) const {
    int points = 0;
    int found = 0;
    for (double share = 0; share <= 1; share += 0.02, ++points)
      found += has_obstacle(x + share * (to_x - x), y + share * (to_y - y)) ? 1 : 0;
    return static_cast<double>(found) / points;
  }

  double drawn_box(double x, double y, double width, double depth) const {
    return (drawn(x, y, x + width, y) + drawn(x + width, y, x + width, y + depth) +
            drawn(x + width, y + depth, x, y + depth) + drawn(x, y + depth, x, y)) /
           4;
  }

 private:
  bool has_obstacle(double x, double y) const {
    const int column = static_cast<int>((x - 1.7 - x_min_) / resolution_m_);
    const int row = height_ - 1 - static_cast<int>((y - 1.5 - y_min_) / resolution_m_);
    for (int dx = -2; dx <= 2; ++dx)
      for (int dy = -2; dy <= 2; ++dy)
        if (static_cast<unsigned char>(
                pixels_.at(static_cast<std::size_t>((row + dy) * width_ + column + dx))) < 90)
          return true;
    return false;
  }

  double resolution_m_ = 0;
  double x_min_ = 0;
  double y_min_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::string pixels_;
};

TEST(RecordedFaults, a_pallet_that_comes_and_stays_is_drawn) {
  const auto log = shared_file("faults/pallet-1-4.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  ASSERT_EQ(run_app({log->string(), "-o", (folder.path() / "map").string(), "-q"}).code, 0);
  EXPECT_EQ(MapOfRoom(folder.path() / "map").drawn_box(2.6, 4.0, 0.7, 0.6), 1);
}

TEST(RecordedFaults, a_room_that_changed_is_drawn_as_its_newest_state) {
  const auto log = shared_file("faults/room-3-3.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  ASSERT_EQ(run_app({log->string(), "-o", (folder.path() / "map").string(), "-q"}).code, 0);
  const MapOfRoom map(folder.path() / "map");
  EXPECT_EQ(map.drawn(3.6, 3, 5.4, 3), 0) << "the old wall";
  EXPECT_EQ(map.drawn(3.6, 3.8, 5.4, 3.8), 1) << "the wall";
  EXPECT_EQ(map.drawn(6.15, 7, 6.85, 7), 1) << "the door";
  EXPECT_EQ(map.drawn_box(6.2, 3.2, 0.9, 0.5), 0) << "the shelf";
  EXPECT_GE(map.drawn_box(6.5, 3.9, 0.7, 0.6), 0.75) << "three sides of the pallet";
  EXPECT_THAT(bytes_of(folder.path() / "map" / "summary.json"), HasSubstr("the building changed at ("));
}

TEST(RecordedFaults, a_log_packed_by_bzip2_gives_the_map_of_the_log_packed_by_gzip) {
  const auto bzip2 = shared_file("faults/plain.log.bz2");
  const auto gzip = shared_file("faults/right_fov.log.gz");
  if (!bzip2 || !gzip) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  ASSERT_EQ(run_app({bzip2->string(), "-o", (folder.path() / "a").string(), "-q"}).code, 0);
  ASSERT_EQ(run_app({gzip->string(), "-o", (folder.path() / "b").string(), "-q"}).code, 0);
  for (const char* name : {"trajectory.tum", "map.png"})
    EXPECT_TRUE(bytes_of(folder.path() / "a" / name) == bytes_of(folder.path() / "b" / name)) << name;
}

}  // namespace
}  // namespace psi_slam
