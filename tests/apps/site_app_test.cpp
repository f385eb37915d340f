// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam --continue.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/user_error.h"
#include "session/site_folder.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kScansOfRound = 60;

/// The log of the mirror image of the room, which no pose in the room explains.
std::vector<std::string> mirrored(const std::vector<std::string>& lines) {
  std::vector<std::string> result;
  for (const std::string& line : lines) {
    std::vector<std::string> words = words_of(line);
    std::reverse(words.begin() + 2, words.begin() + 2 + kRoomBeams);
    for (const int pose : {2 + kRoomBeams, 5 + kRoomBeams})
      for (const int word : {pose + 1, pose + 2}) {
        std::string& number = words[static_cast<std::size_t>(word)];
        number = number[0] == '-' ? number.substr(1) : "-" + number;
      }
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
    result.push_back(text);
  }
  return result;
}

class SiteApp : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// Maps a log of the room that begins at scan `first`.
  AppRun map(const std::string& name, int first, const std::vector<std::string>& more = {}) const {
    const std::vector<std::string> lines = room_log_lines(first + 70, kScansOfRound);
    write_lines(path(name), {lines.begin() + first, lines.end()});
    return run(name, more);
  }

  AppRun run(const std::string& name, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{path(name).string(), "--continue", path("site").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_app(arguments);
  }

  /// Largest distance between the places of two runs at equal places of the room.
  double apart_m(const std::string& a, int first_a, const std::string& b, int first_b) const {
    const Trajectory one = read_trajectory(path("site") / a / "trajectory.tum");
    const Trajectory other = read_trajectory(path("site") / b / "trajectory.tum");
    double worst_m = 0;
    for (int i = std::max(first_a, first_b); i < std::min(first_a, first_b) + 70; ++i) {
      const auto& p = one.at(static_cast<std::size_t>(i - first_a)).pose;
      const auto& q = other.at(static_cast<std::size_t>(i - first_b)).pose;
      worst_m = std::max(worst_m, std::hypot(p.x - q.x, p.y - q.y));
    }
    return worst_m;
  }

  TemporaryFolder folder_;
};

TEST_F(SiteApp, runs_extend_one_map_in_one_frame) {
  const AppRun first = map("monday.log", 0);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("run 1: the map of the site begins"));
  const AppRun second = map("tuesday.log", 20);
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.out, HasSubstr("run 2: no wall of at least 0.5 m has changed"));
  EXPECT_THAT(second.err, IsEmpty());
  const SiteFolder site(path("site"));
  ASSERT_EQ(site.runs().size(), 2U);
  EXPECT_EQ(site.runs()[1].log, "tuesday.log");
  EXPECT_GT(site.runs()[1].path_length_m, 15);
  EXPECT_LT(apart_m("0001-monday", 0, "0002-tuesday", 20), 0.06);
  EXPECT_EQ(read_file(path("site") / "newest" / "map.pgm"),
            read_file(path("site") / "0002-tuesday" / "map.pgm"));
}

TEST_F(SiteApp, a_run_elsewhere_is_not_part_of_the_site) {
  ASSERT_EQ(map("monday.log", 0, {"-q"}).code, 0);
  write_lines(path("elsewhere.log"), mirrored(room_log_lines(70, kScansOfRound)));
  const AppRun elsewhere = run("elsewhere.log");
  EXPECT_EQ(elsewhere.code, 2);
  EXPECT_THAT(elsewhere.err, HasSubstr("this run is not part of the site"));
  EXPECT_THAT(elsewhere.err, HasSubstr("could not be aligned with the newest map"));
  EXPECT_TRUE(fs::exists(path("site") / "0002-elsewhere" / "map.png")) << "its results are written";
  const AppRun next = map("tuesday.log", 10, {"-q"});
  EXPECT_EQ(next.code, 0) << next.err;
  const SiteFolder site(path("site"));
  ASSERT_EQ(site.runs().size(), 2U);
  EXPECT_EQ(site.runs()[1].folder, "0003-tuesday");
}

TEST_F(SiteApp, a_run_that_began_before_another_one_ended_is_not_part_of_the_site) {
  ASSERT_EQ(map("monday.log", 0, {"-q"}).code, 0);
  ASSERT_EQ(map("tuesday.log", 10, {"-q", "--save-session", path("s").string()}).code, 0);
  // The session of Tuesday extends the map of Monday, which is no longer the newest.
  const AppRun again = run_app({"--resume", path("s").string(), "--continue", path("site").string()});
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("another run has been added since this one began"));
  fs::remove_all(path("site") / "0002-tuesday");
  const AppRun restored =
      run_app({"--resume", path("s").string(), "--continue", path("site").string(), "-q"});
  EXPECT_EQ(restored.code, 0) << restored.err;
  EXPECT_EQ(SiteFolder(path("site")).runs().size(), 2U);
}

TEST_F(SiteApp, refuses_another_folder_and_other_commands) {
  write_lines(path("room.log"), room_log_lines(5));
  EXPECT_THAT(run("room.log", {"-o", path("out").string()}).err, HasSubstr("--continue contradicts -o"));
  EXPECT_EQ(run_app({"check", path("room.log").string(), "--continue", path("site").string()}).code, 2);
  write_file(path("site"), "");
  const AppRun file = run("room.log");
  EXPECT_EQ(file.code, 2);
  EXPECT_THAT(file.err, HasSubstr("is a file, expected the folder of a site"));
}

}  // namespace
}  // namespace psi_slam
