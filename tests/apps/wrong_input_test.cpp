// SPDX-License-Identifier: BSD-3-Clause
// Tests faults of logs, folders and disks. Each must give an error message of one line and an exit code: 2
// for wrong input, 1 for a failure of the system.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/trajectory/trajectory_file.h"
#include "rawlog_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

class WrongInput : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    write_bytes(folder_.path() / name, bytes);
    return (folder_.path() / name).string();
  }

  std::string room_log(const std::vector<std::string>& lines) const {
    return write_lines(folder_.path() / "room.log", lines).string();
  }

  std::string output() const { return (folder_.path() / "out").string(); }

  AppRun map(const std::string& log, std::vector<std::string> options = {}) const {
    options.insert(options.end(), {log, "-o", output()});
    return run_app(options);
  }

  /// Maps a log that must be refused with exit code 2 and without results. Returns the error message.
  std::string refusal(const std::string& log, const std::vector<std::string>& options = {}) const {
    const AppRun run = map(log, options);
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(!fs::exists(output()) || fs::is_empty(output()));
    return one_sentence(run.err);
  }

  static std::string one_sentence(const std::string& err) {
    EXPECT_THAT(err, MatchesRegex("psi-slam: [^\n]+\n")) << "one line";
    return err;
  }

  TemporaryFolder folder_;
};

TEST_F(WrongInput, an_empty_log) {
  EXPECT_THAT(refusal(write("empty.log", "")), HasSubstr("empty.log is empty"));
  EXPECT_THAT(refusal(write("empty.rawlog", "")), HasSubstr("empty.rawlog is empty"));
}

TEST_F(WrongInput, a_missing_log_is_reported_before_the_folder_is_made) {
  EXPECT_THAT(refusal((folder_.path() / "missing.log").string()), HasSubstr("missing.log does not exist"));
  EXPECT_FALSE(fs::exists(output()));
}

TEST_F(WrongInput, a_file_that_is_no_log) {
  EXPECT_THAT(
      refusal(write("letter.rawlog", "Dear robot,\nwhere have you been?\n")),
      AllOf(HasSubstr("letter.rawlog has an unknown format"),
            HasSubstr("expected a CARMEN log or an MRPT .rawlog, plain or compressed, or a ROS bag")));
  EXPECT_THAT(refusal(folder_.path().string()), HasSubstr("is a folder"));
}

TEST_F(WrongInput, a_rawlog_truncated_in_its_first_scan) {
  if (!fs::exists(kQuickstartLog)) GTEST_SKIP() << kNeedsQuickstartLog;
  const std::string bytes = bytes_of(kQuickstartLog);
  EXPECT_THAT(refusal(write("cut.rawlog", bytes.substr(0, 1000))), HasSubstr("cut.rawlog"));
}

TEST_F(WrongInput, a_truncated_rawlog_is_mapped_up_to_the_damage) {
  if (!fs::exists(kQuickstartLog)) GTEST_SKIP() << kNeedsQuickstartLog;
  const std::string bytes = bytes_of(kQuickstartLog);
  const AppRun run = map(write("cut.rawlog", bytes.substr(0, 100'000)));
  EXPECT_EQ(run.code, 2);
  const std::size_t scans = read_trajectory(output() + "/trajectory.tum").size();
  EXPECT_GT(scans, 50U);
  EXPECT_LT(scans, 200U);
  EXPECT_THAT(
      one_sentence(run.err),
      AllOf(HasSubstr("cut.rawlog"), HasSubstr("the map shows the " + std::to_string(scans) + " scans")));
}

// Scans alone suffice for a map, which psi-slam says in one sentence.
TEST_F(WrongInput, a_log_without_odometry_is_mapped) {
  const auto sentence = [&](const std::string& log) {
    const AppRun run = map(log, {"--force"});
    EXPECT_EQ(run.code, 0);
    return one_sentence(run.err);
  };
  std::string carmen;
  for (int i = 0; i < 5; ++i)
    carmen += "RAWLASER1 0 -1.5708 3.14159 1.5708 30 0.01 0 3 1.0 2.0 3.0 0 " + std::to_string(10 + i) +
              " host 1\n";
  EXPECT_THAT(sentence(write("raw.log", carmen)), HasSubstr("the log has no odometry"));
  const fs::path rawlog = folder_.path() / "scans.rawlog";
  write_rawlog(rawlog, {range_scan(1'000'000), range_scan(2'000'000)});
  EXPECT_THAT(sentence(rawlog.string()), HasSubstr("the log has no odometry"));
  const AppRun topic = map(rawlog.string(), {"--force", "--set", "log.odometry=/odom"});
  EXPECT_EQ(topic.code, 2);
  EXPECT_THAT(one_sentence(topic.err), HasSubstr("log.odometry is \"/odom\", expected auto or none"));
}

TEST_F(WrongInput, a_log_without_laser) {
  EXPECT_THAT(refusal(write("wheels.log", "ODOM 0 0 0 0 0 0 1.0 host 1.0\nODOM 1 0 0 0 0 0 2.0 host 2.0\n")),
              HasSubstr("wheels.log has no laser scans"));
  const fs::path rawlog = folder_.path() / "wheels.rawlog";
  write_rawlog(rawlog, {odometry(1'000'000, {0, 0, 0}), odometry(2'000'000, {1, 0, 0})});
  EXPECT_THAT(refusal(rawlog.string()), HasSubstr("wheels.rawlog has no laser scans"));
}

TEST_F(WrongInput, a_log_without_a_single_return) {
  auto lines = room_log_lines(5);
  for (std::string& line : lines) line = with_ranges(line, 0, kRoomBeams, "-1");
  EXPECT_THAT(refusal(room_log(lines)), HasSubstr("none of its 5 scans has a return"));
}

TEST_F(WrongInput, ranges_that_are_no_numbers_or_negative_are_no_returns) {
  auto lines = room_log_lines(60);
  for (std::string& line : lines) {
    line = with_ranges(line, 0, 10, "nan");
    line = with_ranges(line, 50, 60, "-1.5");
    line = with_ranges(line, 100, 105, "inf");
    line = with_ranges(line, 120, 125, "0");
  }
  const AppRun run = map(room_log(lines));
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "");
  const Trajectory trajectory = read_trajectory(output() + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 60U);
  const auto moved = trajectory[59].pose - trajectory[0].pose;
  const auto truth = room_pose(2 * M_PI * 59 / 100) - room_pose(0);
  EXPECT_LT(std::hypot(moved.x - truth.x, moved.y - truth.y), 0.05);
}

TEST_F(WrongInput, a_malformed_line_is_skipped_with_a_warning) {
  auto lines = room_log_lines(60);
  lines[30] = "FLASER 181 1.0 2.0";
  const std::string log = room_log(lines);
  const AppRun run = map(log);
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(one_sentence(run.err),
              AllOf(HasSubstr("1 message of the log is unusable"), HasSubstr("room.log:31:")));
  EXPECT_EQ(read_trajectory(output() + "/trajectory.tum").size(), 59U);
  for (const std::string name : {"report.html", "summary.json"})
    EXPECT_THAT(bytes_of(output() + "/" + name), HasSubstr("1 message of the log is unusable"));
  const AppRun check = run_app({"check", log});
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, HasSubstr("1 message of the log is unusable"));
}

TEST_F(WrongInput, time_that_runs_backwards_is_mapped_in_the_order_of_the_file) {
  auto lines = room_log_lines(60);
  for (std::size_t i = 20; i < 30; ++i) {  // ten scans with time stamps in reverse order
    const std::string stamp = words_of(lines[i])[2 + kRoomBeams + 6];
    lines[i].replace(lines[i].find(stamp), stamp.size(), "1003." + std::to_string(500000 - 1000 * i));
  }
  const std::string log = room_log(lines);
  EXPECT_EQ(map(log).code, 0);
  const Trajectory trajectory = read_trajectory(output() + "/trajectory.tum");
  ASSERT_EQ(trajectory.size(), 60U);
  EXPECT_GT(trajectory[20].time_us, trajectory[21].time_us);
  const AppRun check = run_app({"check", log});
  EXPECT_EQ(check.code, 0);
  EXPECT_THAT(check.out, HasSubstr("time runs backwards at"));
}

TEST_F(WrongInput, an_output_that_is_not_an_empty_folder) {
  fs::create_directory(output());
  write_bytes(output() + "/map.png", "precious");
  const AppRun run = map(room_log(room_log_lines(5)));
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(one_sentence(run.err), AllOf(HasSubstr("is not empty"), HasSubstr("--force")));
  EXPECT_EQ(bytes_of(output() + "/map.png"), "precious");
  const AppRun below = run_app({room_log(room_log_lines(5)), "-o", output() + "/map.png/below"});
  EXPECT_EQ(below.code, 2);
  EXPECT_THAT(one_sentence(below.err), HasSubstr("map.png is a file, not a folder"));
}

TEST_F(WrongInput, an_unwritable_output) {
  const AppRun run = run_app({room_log(room_log_lines(5)), "-o", "/proc/psi-slam"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(one_sentence(run.err), HasSubstr("cannot create the output folder /proc/psi-slam"));
}

TEST_F(WrongInput, a_full_disk) {
  const std::string log = room_log(room_log_lines(60));
  for (const rlim_t bytes : {1000U, 20'000U, 60'000U}) {
    const std::string folder = output() + std::to_string(bytes);
    const AppProcess process({log, "-o", folder}, folder_.path(), [&] {
      const rlimit limit{bytes, bytes};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    });
    const AppRun run = process.finish();
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(one_sentence(run.err), HasSubstr("cannot write " + folder)) << bytes;
    EXPECT_TRUE(fs::is_empty(folder)) << "half of the results are left behind";
  }
}

TEST_F(WrongInput, an_unwritable_standard_output) {
  const AppProcess process({"--dump-config"}, folder_.path(),
                           [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(one_sentence(run.err), HasSubstr("standard output"));
}

TEST_F(WrongInput, mistakes_in_a_settings_file_have_file_and_line) {
  const std::string log = room_log(room_log_lines(5));
  const std::string ini = (folder_.path() / "my.ini").string();
  write_bytes(ini, "[front_end]\n\nnode_distanc_m = 0.2\n");
  EXPECT_EQ(refusal(log, {"-c", ini}),
            "psi-slam: " + ini +
                ":3: unknown key \"node_distanc_m\" in [front_end]; did you mean \"node_distance_m\"?\n");
  write_bytes(ini, "[front_end]\nnode_distance_m = wide\n");
  EXPECT_EQ(refusal(log, {"-c", ini}),
            "psi-slam: " + ini +
                ":2: front_end.node_distance_m = wide: expected a number of metres between 0 and 100\n");
  write_bytes(ini, "include = missing.ini\n");
  EXPECT_THAT(refusal(log, {"-c", ini}),
              AllOf(HasSubstr(ini + ":1: cannot read the included file"), HasSubstr("missing.ini")));
  write_bytes(ini, "[log]\nmin_range_m = 3\nmax_range_m = 2\n");
  EXPECT_THAT(refusal(log, {"-c", ini}),
              HasSubstr("log.min_range_m = 3 must be less than log.max_range_m = 2"));
  EXPECT_THAT(refusal(log, {"-c", "missing.ini"}), HasSubstr("cannot read missing.ini: No such file"));
}

TEST_F(WrongInput, old_option_names_give_warnings) {
  const std::string ini = (folder_.path() / "my.ini").string();
  write_bytes(ini, "[log]\nodometry_topic = none\n");
  const AppRun run = run_app({"--dump-config", "-c", ini, "--set", "front_end.window_m=0.3"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err,
            "psi-slam: " + ini +
                ":2: option log.odometry_topic was renamed; write log.odometry\n"
                "psi-slam: --set: front_end.window_m (always 0.15) has no effect any more; remove it\n");
  EXPECT_THAT(run.out, AllOf(HasSubstr("\nodometry = none\n"), Not(HasSubstr("\nwindow_m"))));
}

TEST_F(WrongInput, mistakes_in_overrides_name_the_option) {
  const std::string log = room_log(room_log_lines(5));
  EXPECT_EQ(refusal(log, {"--set", "log.mirored=true"}),
            "psi-slam: --set: unknown key \"mirored\" in [log]; did you mean \"mirrored\"?\n");
  EXPECT_EQ(refusal(log, {"--set", "log.mirrored=maybe"}),
            "psi-slam: --set: log.mirrored = maybe: expected true or false\n");
  EXPECT_EQ(refusal(log, {"--set", "mirrored"}),
            "psi-slam: --set: expected section.key=value, not \"mirrored\"\n");
  EXPECT_EQ(refusal(log, {"--seed", "-3"}),
            "psi-slam: --seed: run.seed = -3: expected a whole number, 0 or more\n");
  EXPECT_THAT(refusal(log, {"--threads", "many"}),
              StartsWith("psi-slam: --threads: run.threads = many: expected"));
}

}  // namespace
}  // namespace psi_slam
