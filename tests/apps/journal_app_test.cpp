// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam with --journal: the program is killed at random moments and its run resumed.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "../session/room_log.h"
#include "app_run.h"
#include "same_results.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

class JournalApp : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Returns the arguments of a run with the journal, without its input.
  std::vector<std::string> journalled(std::vector<std::string> arguments, const std::string& output) const {
    arguments.insert(arguments.end(), {"-q", "-o", file(output), "--journal", journal_, "--set",
                                       "live.journal_period_s=0.05", "--set", "map.write_mrpt=false"});
    return arguments;
  }

  TemporaryFolder folder_;
  const std::string journal_ = file("my.journal");
  const std::string log_ = write_lines(folder_.path() / "room.log", room_log_lines(130)).string();
};

TEST_F(JournalApp, a_run_that_is_killed_at_any_moment_gives_the_same_bytes_when_resumed) {
  const bool is_long = std::getenv("PSI_SLAM_LONG_TESTS") != nullptr;
  const int kills = is_long ? 200 : 5;
  const auto begin = Clock::now();
  ASSERT_EQ(AppProcess(journalled({log_}, "whole"), folder_.path()).finish().code, 0);
  const double duration_s = Seconds(Clock::now() - begin).count();
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> moment_s(0, duration_s);
  int with_journal = 0;
  const int enough = kills / 5;
  // On a loaded machine, a run may be slower or faster than the first, so that a kill comes too early or
  // late.
  for (int i = 0; i < kills || (with_journal < enough && i < 20 * kills); ++i) {
    const AppProcess run(journalled({log_}, "killed"), folder_.path());
    std::this_thread::sleep_for(Seconds(moment_s(random)));
    run.send(SIGKILL);
    run.finish();
    fs::remove_all(file("killed"));
    if (!fs::exists(journal_)) continue;  // killed before the first scan, or after the run had finished
    ++with_journal;
    const AppRun resumed = run_app(journalled({"--resume", journal_, log_}, "resumed"));
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_THAT(resumed.err, testing::AnyOf("", HasSubstr("ends with an incomplete chunk")));
    expect_same_results(file("whole"), file("resumed"));
    EXPECT_FALSE(fs::exists(journal_)) << "a run that finishes deletes its journal";
    fs::remove_all(file("resumed"));
  }
  EXPECT_GE(with_journal, enough) << "otherwise the test would show nothing";
}

TEST_F(JournalApp, the_saved_session_replaces_the_journal) {
  for (const std::string& session : {file("my.session"), journal_}) {
    ASSERT_EQ(run_app(journalled({log_, "--save-session", session}, "out")).code, 0);
    EXPECT_EQ(fs::exists(journal_), session == journal_);
    EXPECT_EQ(bytes_of(session).substr(0, 16), "psi-slam session");
    fs::remove_all(file("out"));
  }
}

TEST_F(JournalApp, wrong_usage_gives_one_sentence) {
  write_bytes(journal_, "psi-slam journal");
  const auto expect_refused = [](const std::vector<std::string>& arguments, const std::string& why) {
    const AppRun run = run_app(arguments);
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(why));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "one sentence: " << run.err;
  };
  expect_refused(journalled({log_}, "out"),
                 "the file exists. Resume it with psi-slam --resume " + journal_ + ", or replace it");
  expect_refused({"--resume", journal_, "-o", file("out")}, "my.journal is damaged");
  expect_refused({log_, "-o", file("out"), "--journal", folder_.path().string()}, "is a folder");
  expect_refused({"check", log_, "--journal", journal_}, "--journal");
  expect_refused({journal_, "-o", file("out")}, "my.journal is a session, not a log");
}

}  // namespace
}  // namespace psi_slam
