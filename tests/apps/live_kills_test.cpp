// SPDX-License-Identifier: BSD-3-Clause
// Kills psi-slam live at random moments, and resumes each run from its journal alone. The test prints the
// figures of share/doc/live.md.
#include <gmock/gmock.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <random>
#include <set>
#include <thread>

#include "../session/room_log.h"
#include "app_run.h"
#include "sender.h"
#include "session/session_file.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kLines = 150;
constexpr double kScansPerSecond = 100;

/// What a killed run had received and kept.
struct KilledRun {
  std::vector<Clock::time_point> sent;  ///< when each scan was sent
  std::size_t mapped = 0;               ///< number of scans whose poses the program had printed
  std::size_t recorded = 0;             ///< number of scans in the journal

  /// Time in seconds from the last recorded scan, or from the first scan, to the last mapped scan.
  double loss_s() const {
    if (mapped <= recorded) return 0;
    return Seconds(sent[mapped - 1] - sent[std::max<std::size_t>(recorded, 1) - 1]).count();
  }
};

class LiveKills : public testing::Test {
 protected:
  fs::path file(const std::string& name) const { return folder_.path() / name; }

  static std::vector<std::string> quick(std::vector<std::string> arguments, const fs::path& output) {
    arguments.insert(arguments.end(), {"-q", "-o", output.string(), "--set", "map.write_mrpt=false"});
    return arguments;
  }

  /// Sends the scans at a steady pace to a live run with the default period of the journal. Kills the run
  /// `moment_s` seconds after the first scan.
  KilledRun kill_after(double moment_s) const {
    fs::remove_all(live_);
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
      throw std::runtime_error("cannot connect to the program");
    const Descriptor robot(ends[0]);
    const Descriptor input(ends[1]);
    const AppProcess process(quick({"live", "--stdin", "--look-over-s", "0", "--poses", "tum"}, live_),
                             folder_.path(), [&] { ::dup2(input.number(), STDIN_FILENO); });
    if (!soon([&] { return fs::exists(journal_); })) throw std::runtime_error(bytes_of(file("stderr")));
    KilledRun run;
    const Clock::time_point begin = Clock::now();
    const auto after = [&](double time_s) {
      return begin + std::chrono::duration_cast<Clock::duration>(Seconds(time_s));
    };
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double due_s = static_cast<double>(i) / kScansPerSecond;
      if (due_s >= moment_s) break;
      std::this_thread::sleep_until(after(due_s));
      send_text(robot.number(), lines_[i] + '\n');
      run.sent.push_back(Clock::now());
    }
    std::this_thread::sleep_until(after(moment_s));
    process.send(SIGKILL);
    const std::string poses = process.finish().out;
    run.mapped = static_cast<std::size_t>(std::count(poses.begin(), poses.end(), '\n'));
    run.recorded = read_session_file(journal_).frames.size();
    return run;
  }

  /// Expects that the journal gives the map of its scans alone.
  void expect_resumed(std::size_t scans) {
    const fs::path whole = file("first-" + std::to_string(scans));
    if (mapped_.insert(scans).second) {
      const auto end = lines_.begin() + static_cast<std::ptrdiff_t>(scans);
      const fs::path log = write_lines(file("first.log"), {lines_.begin(), end});
      ASSERT_EQ(run_app(quick({log.string()}, whole)).code, 0);
    }
    fs::remove_all(file("resumed"));
    const AppRun resumed = run_app(quick({"--resume", journal_.string()}, file("resumed")));
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    for (const char* name : {"map.pgm", "map.yaml", "trajectory.tum", "graph.g2o"})
      ASSERT_EQ(bytes_of(file("resumed") / name), bytes_of(whole / name)) << name;
  }

  TemporaryFolder folder_;
  const fs::path live_ = file("live");
  const fs::path journal_ = live_ / "session.journal";
  const std::vector<std::string> lines_ = room_log_lines(kLines);
  std::set<std::size_t> mapped_;  ///< numbers of scans that expect_resumed() has mapped
};

TEST_F(LiveKills, a_killed_run_loses_at_most_a_second_and_gives_the_map_of_the_others) {
  const bool is_long = std::getenv("PSI_SLAM_LONG_TESTS") != nullptr;
  const int kills = is_long ? 200 : 3;
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> moment_s(0.1, 1.05 * kLines / kScansPerSecond);
  double largest_s = 0;
  double sum_s = 0;
  std::size_t largest_scans = 0;
  int resumed = 0;
  for (int i = 0; i < kills; ++i) {
    const KilledRun run = kill_after(moment_s(random));
    SCOPED_TRACE(testing::Message() << "kill " << i << ": " << run.sent.size() << " scans sent, "
                                    << run.mapped << " mapped, " << run.recorded << " recorded");
    EXPECT_LE(run.loss_s(), 1);
    largest_s = std::max(largest_s, run.loss_s());
    sum_s += run.loss_s();
    if (run.mapped > run.recorded) largest_scans = std::max(largest_scans, run.mapped - run.recorded);
    if (run.recorded == 0) continue;  // there is nothing to resume
    ++resumed;
    ASSERT_NO_FATAL_FAILURE(expect_resumed(run.recorded));
  }
  EXPECT_GE(resumed, kills / 2) << "otherwise the test would show little";
  std::cout << "[ figures  ] " << kills << " kills: " << resumed << " runs resumed; lost time: mean "
            << sum_s / kills << " s, largest " << largest_s << " s, at most " << largest_scans << " scans\n";
}

}  // namespace
}  // namespace psi_slam
