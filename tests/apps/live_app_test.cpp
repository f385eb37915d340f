// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam live.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "../live/hokuyo_emulator.h"
#include "../session/room_log.h"
#include "app_run.h"
#include "bag_files.h"
#include "map/trajectory/trajectory_file.h"
#include "same_results.h"
#include "sender.h"
#include "session/session_file.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr std::size_t kScans = 40;

std::string text_of(const std::vector<std::string>& lines, std::size_t begin, std::size_t end) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) text += lines[i] + '\n';
  return text;
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// A log of a room, and the results of mapping it as a file.
class LiveApp : public testing::Test {
 protected:
  void SetUp() override {
    write_lines(log_, lines_);
    ASSERT_EQ(run_app({log_.string(), "-q", "-o", folder("whole").string()}).code, 0);
  }

  std::filesystem::path folder(const std::string& name) const { return folder_.path() / name; }

  std::vector<std::string> live(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "live");
    arguments.insert(arguments.end(), {"-o", folder("live").string()});
    return arguments;
  }

  std::string out() const { return bytes_of(folder("stdout")); }
  std::string err() const { return bytes_of(folder("stderr")); }
  std::filesystem::path journal() const { return folder("live") / "session.journal"; }

  /// Whether the journal holds this number of scans.
  bool are_recorded(std::size_t scans) const {
    return std::filesystem::exists(journal()) && read_session_file(journal()).frames.size() == scans;
  }

  /// Expects the same map and path as those of the whole log.
  void expect_same_map() const {
    for (const char* name : {"map.pgm", "map.yaml", "trajectory.tum", "graph.g2o"})
      EXPECT_EQ(bytes_of(folder("live") / name), bytes_of(folder("whole") / name)) << name;
  }

  TemporaryFolder folder_;
  std::filesystem::path log_ = folder("room.log");
  std::vector<std::string> lines_ = room_log_lines(kScans, 35);
};

TEST_F(LiveApp, maps_standard_input_as_the_log) {
  const AppProcess process(live({"--stdin", "-q"}), folder_.path(),
                           [&] { ::dup2(::open(log_.c_str(), O_RDONLY), STDIN_FILENO); });
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  expect_same_results(folder("live"), folder("whole"));
}

TEST_F(LiveApp, maps_what_clients_send_until_it_is_interrupted) {
  const AppProcess process(live({"--tcp", "0"}), folder_.path());
  ASSERT_TRUE(soon([&] { return port_in(err()) != 0; })) << err();
  {
    const Descriptor first = connect_to(port_in(err()));
    send_text(first.number(), text_of(lines_, 0, 30) + lines_[30].substr(0, 100));
  }
  ASSERT_TRUE(soon([&] { return err().find("disconnected") != std::string::npos; })) << err();
  {
    const Descriptor second = connect_to(port_in(err()));
    send_text(second.number(), text_of(lines_, 30, kScans) + "garbage\nFLASER 180 1\n");
  }
  ASSERT_TRUE(soon([&] { return err().rfind("disconnected") != err().find("disconnected"); })) << err();
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("40 scans of TCP port"));
  EXPECT_THAT(run.err, AllOf(HasSubstr("finishing the map"),
                             HasSubstr("2 messages of the log are unusable and skipped, the first: TCP port"),
                             Not(HasSubstr("damaged"))));
  expect_same_map();
}

TEST_F(LiveApp, a_second_interrupt_at_any_time_leaves_the_map) {
  const AppProcess process(live({"--follow", log_.string(), "--poses", "tum"}), folder_.path());
  ASSERT_TRUE(soon([&] { return lines_in(out()) > 0; })) << err();
  process.send(SIGSTOP);  // both signals come at once, before the first one is looked at
  process.send(SIGINT);
  process.send(SIGTERM);
  process.send(SIGCONT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("Interrupt again to finish it without more loops"),
                             HasSubstr("scans of room.log")));
  EXPECT_TRUE(std::filesystem::exists(folder("live") / "map.pgm"));
}

TEST_F(LiveApp, writes_the_map_and_a_journal_while_it_maps_and_can_be_resumed_after_a_crash) {
  const auto growing = folder("growing.log");
  write_file(growing, text_of(lines_, 0, 30));
  {
    const AppProcess process(live({"--follow", growing.string(), "--look-over-s", "1", "--set",
                                   "live.map_period_s=0.05", "--set", "live.journal_period_s=0.05"}),
                             folder_.path());
    EXPECT_TRUE(soon([&] { return are_recorded(30); })) << err();
    std::ofstream(growing, std::ios::app) << text_of(lines_, 30, kScans);
    EXPECT_TRUE(soon([&] { return are_recorded(kScans); })) << err();
    EXPECT_TRUE(soon([&] { return std::filesystem::exists(folder("live") / "map.yaml"); })) << err();
    EXPECT_TRUE(std::filesystem::exists(folder("live") / "map.pgm"));
    process.send(SIGKILL);
    EXPECT_NE(process.finish().code, 0);
  }
  const AppRun again = run_app(live({"--stdin", "--force"}));
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err,
              AllOf(HasSubstr("session.journal holds a run that was not finished"), HasSubstr("--resume")));
  const AppRun resumed = run_app({"--resume", journal().string(), "-q", "-o", folder("resumed").string()});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  for (const char* name : {"map.pgm", "map.yaml", "trajectory.tum", "graph.g2o"})
    EXPECT_EQ(bytes_of(folder("resumed") / name), bytes_of(folder("whole") / name)) << name;
}

TEST_F(LiveApp, goes_on_live_after_a_crash) {
  const auto growing = folder("growing.log");
  write_file(growing, text_of(lines_, 0, 30));
  {
    const AppProcess process(
        live({"--follow", growing.string(), "--look-over-s", "0", "--set", "live.journal_period_s=0.05"}),
        folder_.path());
    ASSERT_TRUE(soon([&] { return are_recorded(30); })) << err();
  }  // killed
  std::ofstream(growing, std::ios::app) << text_of(lines_, 30, kScans);
  const std::vector<std::string> again = {
      "--resume", journal().string(), "--follow", growing.string(), "--idle-s", "0", "--poses", "tum", "-q"};
  EXPECT_THAT(run_app(live(again)).err, HasSubstr("is not empty")) << "the folder has the journal";
  std::vector<std::string> with_force = live(again);
  with_force.push_back("--force");
  const AppRun resumed = run_app(with_force);
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(resumed.err,
            "psi-slam: skipping scans up to 1005.800000 s, the time of the last recorded scan\n");
  EXPECT_EQ(lines_in(resumed.out), kScans - 30) << "poses of the new scans only";
  EXPECT_FALSE(std::filesystem::exists(journal()));
  expect_same_map();
}

TEST_F(LiveApp, tells_at_once_that_the_journal_cannot_be_written_and_completes_it_later) {
  const auto growing = folder("growing.log");
  write_file(growing, text_of(lines_, 0, 20));
  const AppProcess process(live({"--follow", growing.string(), "--look-over-s", "0", "--set",
                                 "live.map_period_s=0", "--set", "live.journal_period_s=0.05"}),
                           folder_.path(), [] { std::signal(SIGXFSZ, SIG_IGN); });
  const auto tells = [&](const std::string& text) { return err().find(text) != std::string::npos; };
  const auto append = [&](std::size_t begin, std::size_t end) {
    std::ofstream(growing, std::ios::app) << text_of(lines_, begin, end);
  };
  ASSERT_TRUE(soon([&] { return are_recorded(20); })) << err();
  rlimit before{};
  ASSERT_EQ(::prlimit(process.pid(), RLIMIT_FSIZE, nullptr, &before), 0);
  const rlimit full{std::filesystem::file_size(journal()), before.rlim_max};
  ASSERT_EQ(::prlimit(process.pid(), RLIMIT_FSIZE, &full, nullptr), 0);
  append(20, 25);
  EXPECT_TRUE(soon([&] {
    append(25, 26);  // the next scan tells
    return tells("the journal is not written for now, and psi-slam tries again: cannot write " +
                 journal().string());
  })) << err();
  ASSERT_EQ(::prlimit(process.pid(), RLIMIT_FSIZE, &before, nullptr), 0);
  EXPECT_TRUE(soon([&] {
    append(26, 27);
    return tells("the journal is written again");
  })) << err();
  process.send(SIGKILL);
  process.finish();
  const SessionRecording recording = read_session_file(journal());
  EXPECT_GT(recording.frames.size(), 25U);
  EXPECT_FALSE(recording.lost_end);
}

TEST_F(LiveApp, saves_the_session_and_leaves_no_journal) {
  const auto saved = folder("run.session");
  const AppProcess process(live({"--stdin", "-q", "--save-session", saved.string()}), folder_.path(),
                           [&] { ::dup2(::open(log_.c_str(), O_RDONLY), STDIN_FILENO); });
  EXPECT_EQ(process.finish().code, 0) << err();
  EXPECT_EQ(err().find("cannot be resumed"), std::string::npos) << err();
  EXPECT_FALSE(std::filesystem::exists(journal()));
  EXPECT_EQ(read_session_file(saved).frames.size(), kScans);
  ASSERT_EQ(run_app({"--resume", saved.string(), "-q", "-o", folder("resumed").string()}).code, 0);
  EXPECT_EQ(bytes_of(folder("resumed") / "map.pgm"), bytes_of(folder("whole") / "map.pgm"));
}

TEST_F(LiveApp, follows_a_log_and_prints_the_poses_of_its_scans) {
  const auto growing = folder("growing.log");
  write_file(growing, text_of(lines_, 0, 20) + lines_[20].substr(0, 50));
  const AppProcess process(live({"--follow", growing.string(), "--poses", "tum", "--look-over-s", "1"}),
                           folder_.path());
  ASSERT_TRUE(soon([&] { return lines_in(out()) >= 20; })) << err();
  std::ofstream recorder(growing, std::ios::app);
  recorder << lines_[20].substr(50) << '\n' << std::flush;
  ASSERT_TRUE(soon([&] { return lines_in(out()) == 21; })) << err();
  recorder << text_of(lines_, 21, kScans) << std::flush;
  ASSERT_TRUE(soon([&] { return lines_in(out()) == kScans; })) << err();
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(lines_in(run.out), kScans) << "nothing but poses";
  EXPECT_EQ(run.out.substr(0, run.out.find('\n')),
            "1000.000000 0.000000000 0.000000000 0 0 0 0.000000000000 1.000000000000");
  EXPECT_THAT(run.err, HasSubstr("40 scans of growing.log"));
  expect_same_map();
}

TEST_F(LiveApp, prints_poses_as_json) {
  const AppRun run = run_app(live({"--follow", log_.string(), "--idle-s", "0", "--poses", "json"}));
  ASSERT_EQ(run.code, 0) << run.err;
  std::istringstream lines(run.out);
  std::size_t scans = 0;
  std::size_t with_covariance = 0;
  for (std::string line; std::getline(lines, line); ++scans) {
    const auto pose = nlohmann::json::parse(line);
    EXPECT_EQ(pose.at("frame"), scans);
    EXPECT_EQ(pose.at("matched"), scans > 0);
    EXPECT_NEAR(pose.at("time_s"), 1000 + 0.2 * static_cast<double>(scans), 1e-6);
    for (const char* key : {"x_m", "y_m", "yaw_rad"}) EXPECT_TRUE(pose.at(key).is_number());
    if (!pose.contains("covariance")) continue;
    const auto covariance = pose["covariance"].get<std::vector<double>>();
    ASSERT_EQ(covariance.size(), 36U);
    ++with_covariance;
    for (std::size_t row = 0; row < 6; ++row)
      for (std::size_t column = 0; column < 6; ++column)
        EXPECT_NEAR(covariance[6 * row + column], covariance[6 * column + row], 1e-12);
    for (const std::size_t variance : {0U, 7U, 35U}) EXPECT_GT(covariance[variance], 0);
    EXPECT_EQ(covariance[14], 0) << "the height is known";
  }
  EXPECT_EQ(scans, kScans);
  EXPECT_GT(with_covariance, kScans / 2);
  expect_same_map();
}

TEST_F(LiveApp, finishes_the_map_if_nobody_reads_the_poses) {
  const auto nowhere = [] {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return;
    ::close(ends[0]);
    ::dup2(ends[1], STDOUT_FILENO);
  };
  const AppProcess process(live({"--follow", log_.string(), "--idle-s", "0", "--poses", "tum"}),
                           folder_.path(), nowhere);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write to standard output"));
  expect_same_map();
}

TEST_F(LiveApp, one_thread_for_loops_gives_the_same_map) {
  ASSERT_EQ(run_app(live({"--follow", log_.string(), "--idle-s", "0", "-q", "--set", "run.threads=1"})).code,
            0);
  expect_same_results(folder("live"), folder("whole"));
}

TEST_F(LiveApp, a_stream_without_scans_is_an_error) {
  const AppProcess process(live({"--tcp", "0"}), folder_.path());
  ASSERT_TRUE(soon([&] { return port_in(err()) != 0; })) << err();
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("has no laser scans"));
  EXPECT_FALSE(std::filesystem::exists(journal())) << "nothing could be resumed";
}

TEST_F(LiveApp, says_what_is_wrong_with_the_arguments) {
  const auto complaint = [&](const std::vector<std::string>& arguments) {
    const AppRun run = run_app(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.out, "");
    return run.err;
  };
  EXPECT_THAT(complaint(live({})), HasSubstr("name a source: --ros2, --stdin, --tcp PORT"));
  EXPECT_THAT(complaint({"live", "--stdin"}),
              HasSubstr("name the folder for the results, or a site to continue: -o DIR or --continue SITE"));
  EXPECT_THAT(complaint(live({"--stdin", "--tcp", "5000"})), HasSubstr("name only one source"));
  EXPECT_THAT(complaint(live({"--stdin", "--bind", "0.0.0.0"})),
              HasSubstr("--bind has no effect without --tcp"));
  EXPECT_THAT(complaint(live({"--tcp", "x"})),
              HasSubstr("--tcp x: expected the number of a port, 0 to 65535"));
  EXPECT_THAT(complaint(live({"--tcp", "65536"})), HasSubstr("--tcp 65536: expected the number of a port"));
  EXPECT_THAT(complaint(live({"--stdin", "--idle-s", "-1"})), HasSubstr("--idle-s -1: expected seconds"));
  EXPECT_THAT(complaint(live({"--stdin", "--look-over-s", "a"})),
              HasSubstr("--look-over-s a: expected seconds"));
  EXPECT_THAT(complaint(live({"--stdin", "--poses", "xml"})), HasSubstr("--poses xml: expected tum or json"));
  EXPECT_THAT(complaint(live({"--stdin", "--poses", "tum", "--json"})),
              HasSubstr("--json contradicts --poses"));
  EXPECT_THAT(complaint(live({"--follow", log_.string(), "--set", "log.calibrate=true"})),
              HasSubstr("log.calibrate needs a complete log"));
  EXPECT_THAT(complaint(live({"--stdin", "--domain", "1"})),
              HasSubstr("--domain has no effect without --ros2"));
  EXPECT_THAT(complaint(live({"--stdin", "--record", "a.mcap"})),
              HasSubstr("--record has no effect without --ros2"));
  EXPECT_THAT(complaint(live({"--ros2", "--domain", "233"})),
              HasSubstr("--domain 233: expected a whole number"));
  EXPECT_THAT(complaint(live({"--ros2", "--namespace", "a b"})),
              HasSubstr("--namespace /a b: expected letters"));
  EXPECT_THAT(complaint(live({"--ros2", "--topic", "scan"})), HasSubstr("--topic scan: expected NAME=TOPIC"));
  EXPECT_THAT(complaint(live({"--ros2", "--topic", "laser=/scan"})),
              HasSubstr("there is no topic \"laser\", expected one of scan, odom"));
  EXPECT_THAT(complaint({"play", "my.log"}), HasSubstr("name the log, and add --ros2"));
  EXPECT_THAT(complaint({"localize", "map.yaml", "--idle-s", "1"}),
              HasSubstr("--idle-s needs a live source"));
  EXPECT_THAT(complaint({"localize", "map.yaml", "my.log", "--stdin"}), HasSubstr("a log or a live source"));
  EXPECT_FALSE(std::filesystem::exists(folder("live")));
}

TEST_F(LiveApp, maps_what_a_laser_measures) {
  const auto port = folder("ttyLASER");
  const auto settings = folder("sensors.ini");
  write_file(settings,
             "[LASER]\ndriver = CHokuyoURG\nsensorLabel = LASER\nprocess_rate = 500\ncomms_timeout_ms = 30\n"
             "maxMissedScansToDeclareError = 300\ndisable_firmware_timestamp = true\nCOM_port_LIN = " +
                 port.string() + '\n');
  constexpr double kStep_rad = M_PI / 360;
  const mrpt::math::TPose2D start = room_pose(0);
  std::vector<HokuyoEmulator::Message> scans(kScans);
  mrpt::math::TPose2D end;
  for (std::size_t i = 0; i < kScans; ++i) {
    const mrpt::math::TPose2D pose = room_pose(0.02 * static_cast<double>(i));
    end = pose - start;
    for (std::size_t beam = 0; beam < HokuyoEmulator::kBeams; ++beam)
      scans[i].ranges_m.push_back(static_cast<float>(
          room_range_m(pose.x, pose.y, pose.phi + kStep_rad * (static_cast<double>(beam) - 180))));
  }
  const HokuyoEmulator laser(port, scans);
  const AppProcess process(live({"--sensors", settings.string(), "--poses", "tum", "--look-over-s", "0"}),
                           folder_.path());
  ASSERT_TRUE(soon([&] { return lines_in(out()) >= kScans; })) << err();
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("sensor [LASER] sends data"), HasSubstr("scans of sensors.ini")));
  const Trajectory poses = read_trajectory(folder("live") / "trajectory.tum");
  EXPECT_NEAR(poses.back().pose.x, end.x, 0.05);
  EXPECT_NEAR(poses.back().pose.y, end.y, 0.05);
  EXPECT_NEAR(poses.back().pose.phi, end.phi, 0.02);
}

/// A drive through the room as messages of ROS 2.
Recording recorded_room(std::size_t scans) {
  Recording recording{static_mount("laser", {})};
  for (std::size_t i = 0; i < scans; ++i) {
    const mrpt::math::TPose2D pose = room_pose(0.02 * static_cast<double>(i));
    const TimeUs time_us = 1'600'000'000'000'000 + static_cast<TimeUs>(i) * 200'000;
    recording.emplace_back(
        RecordedPose{"/odom", time_us, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}});
    RecordedScan scan;
    scan.time_us = time_us;
    scan.angle_min_rad = static_cast<float>(-M_PI / 2);
    scan.angle_increment_rad = static_cast<float>(M_PI / (kRoomBeams - 1));
    scan.ranges_m.clear();
    for (int beam = 0; beam < kRoomBeams; ++beam)
      scan.ranges_m.push_back(static_cast<float>(
          room_range_m(pose.x, pose.y, pose.phi - M_PI / 2 + M_PI * beam / (kRoomBeams - 1))));
    recording.emplace_back(scan);
  }
  return recording;
}

TEST_F(LiveApp, maps_the_folder_of_a_bag_while_rosbag2_records_it) {
  const Recording recording = recorded_room(2 * kScans);
  const auto bag = folder("run");
  std::filesystem::create_directory(bag);
  const AppProcess process(live({"--follow", bag.string(), "--poses", "tum", "--look-over-s", "1"}),
                           folder_.path());
  std::size_t recorded = 0;
  for (const char* name : {"run_0.db3", "run_1.db3"}) {
    Db3Writer writer(bag / name, {"journal_mode=MEMORY", "synchronous=OFF"});
    writer.create_tables();
    const std::size_t end = recorded == 0 ? recording.size() / 2 : recording.size();
    while (recorded < end) {
      writer.begin();
      for (const std::size_t next = std::min(recorded + 5, end); recorded < next; ++recorded)
        writer.add(recording[recorded], cdr(recording[recorded]));
      writer.commit();
    }
    const std::size_t fewest = recorded < recording.size() ? 20 : 2 * kScans - 1;
    EXPECT_TRUE(soon([&] { return lines_in(out()) >= fewest; })) << "poses while the bag grows: " << err();
  }
  write_file(bag / "metadata.yaml",
             "rosbag2_bagfile_information:\n  relative_file_paths:\n    - run_0.db3\n    - run_1.db3\n");
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(lines_in(run.out), 2 * kScans);
  ASSERT_EQ(run_app({bag.string(), "-q", "-o", folder("bag").string()}).code, 0);
  for (const char* name : {"map.pgm", "map.yaml", "trajectory.tum", "graph.g2o"})
    EXPECT_EQ(bytes_of(folder("live") / name), bytes_of(folder("bag") / name)) << name;

  const std::string map = (folder("bag") / "map.yaml").string();
  const AppRun of_bag = run_app({"localize", map, bag.string(), "--json"});
  const AppRun of_stream = run_app({"localize", map, "--follow", bag.string(), "--json"});
  EXPECT_EQ(of_stream.code, of_bag.code) << of_stream.err;
  EXPECT_EQ(of_stream.out, of_bag.out);
}

TEST_F(LiveApp, localizes_while_the_robot_drives) {
  const std::string map = (folder("whole") / "map.yaml").string();
  const AppRun of_log = run_app({"localize", map, log_.string(), "--json"});
  const AppRun of_stream = run_app({"localize", map, "--follow", log_.string(), "--idle-s", "0", "--json"});
  EXPECT_EQ(of_stream.code, of_log.code) << of_stream.err;
  EXPECT_EQ(of_stream.out, of_log.out);
  const AppRun poses = run_app(
      {"localize", map, "--follow", log_.string(), "--idle-s", "0", "--start", "0,0,0", "--poses", "tum"});
  EXPECT_EQ(poses.code, of_log.code) << poses.err;
  EXPECT_EQ(lines_in(poses.out), kScans);
}

}  // namespace
}  // namespace psi_slam
