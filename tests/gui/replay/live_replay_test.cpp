// SPDX-License-Identifier: BSD-3-Clause
// Tests runs of live sources.
#include <gmock/gmock.h>

#include <fstream>
#include <memory>
#include <stdexcept>

#include "../../session/room_log.h"
#include "awaited_snapshot.h"
#include "frames_in_memory.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "same_results.h"
#include "sender.h"
#include "session/session_file.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// A growing log of a room.
class LiveReplay : public testing::Test {
 protected:
  void SetUp() override {
    source_.kind = LiveInput::Kind::kFollow;
    source_.file = (folder_.path() / "growing.log").string();
    source_.look_over_s = 1;
    std::ofstream(source_.file).flush();
  }

  /// Records the log up to its line `end`.
  void record(std::size_t end) {
    std::ofstream file(source_.file, std::ios::app);
    for (; recorded_ < end; ++recorded_) file << lines_[recorded_] << '\n';
  }
  std::filesystem::path out(const std::string& name) const { return folder_.path() / name; }

  static SnapshotPtr wait_for_scans(const Replay& replay, std::size_t scans) {
    return wait_for(replay, [scans](const ReplaySnapshot& now) { return now.frames.size() == scans; });
  }

  TemporaryFolder folder_;
  Settings settings_;
  LiveInput source_;
  const std::vector<std::string> lines_ = room_log_lines();
  std::size_t recorded_ = 0;
};

TEST_F(LiveReplay, maps_scans_as_they_come_to_the_map_of_the_log) {
  Replay replay(live_stream(source_), settings_);
  EXPECT_TRUE(wait_for(replay, ReplayPhase::kPlaying)->live);
  EXPECT_EQ(replay.stamps_us(), nullptr);
  record(60);
  const SnapshotPtr paused = wait_for_scans(replay, 60);
  EXPECT_EQ(paused->phase, ReplayPhase::kPlaying);
  EXPECT_FALSE(paused->nodes.empty());
  record(150);
  const SnapshotPtr live = wait_for_scans(replay, 150);
  const LiveFigures figures = replay.live_figures().value();
  EXPECT_GT(figures.delay_s, 0);
  EXPECT_GE(figures.largest_delay_s, figures.delay_s);
  EXPECT_GT(figures.scans_per_s, 0);
  replay.finish();
  const SnapshotPtr finished = wait_for(replay, ReplayPhase::kFinished);
  EXPECT_FALSE(finished->interrupted);
  EXPECT_FALSE(finished->loops->empty());
  for (std::size_t i = 0; i < 150; ++i)
    EXPECT_EQ(live->frames[i].loops_tried, finished->frames[i].loops_tried) << "scan " << i;
  replay.export_to(out("live"), false);
  EXPECT_EQ(wait_for_export(replay, 1)->exported->failure, "");

  MappingSession session(source_.file, settings_);
  session.run(std::atomic<bool>(false));
  session.export_to(OutputFolder::prepare(out("whole"), false));
  expect_same_results(out("live"), out("whole"));
}

TEST_F(LiveReplay, serves_commands_while_it_waits_for_scans) {
  settings_.run.threads = 1;
  record(140);
  Replay replay(live_stream(source_), settings_);
  const SnapshotPtr mapped = wait_for_scans(replay, 140);
  replay.save_session(out("half.session"));
  EXPECT_EQ(wait_for_save(replay, 1)->saved->written.scans, 140U);
  EXPECT_EQ(read_session_file(out("half.session")).frames.size(), 140U);
  ASSERT_FALSE(mapped->loops->empty());
  const LoopRecord loop = mapped->loops->front();
  replay.edit({LoopEdit::Kind::kDelete, loop.frame, loop.local_map});
  const SnapshotPtr edited =
      wait_for(replay, [](const ReplaySnapshot& now) { return now.edits_served == 1; });
  EXPECT_EQ(edited->phase, ReplayPhase::kPlaying);
  EXPECT_TRUE(rejected_by(edited->loops->front(), LoopRejection::Reason::kDeletedByHand));
  record(150);
  wait_for_scans(replay, 150);
  replay.finish();
  wait_for(replay, ReplayPhase::kFinished);
}

TEST_F(LiveReplay, a_source_that_ends_finishes_the_map) {
  record(40);
  source_.idle_s = 0.2;
  const Replay replay(live_stream(source_), settings_);
  EXPECT_EQ(wait_for(replay, ReplayPhase::kFinished)->frames.size(), 40U);
}

TEST_F(LiveReplay, records_the_scans_in_a_journal_until_it_is_closed) {
  settings_.live.journal_period_s = 0.05;
  const std::filesystem::path journal = out("session.journal");
  {
    const Replay replay(live_stream(source_, journal), settings_);
    record(40);
    EXPECT_TRUE(soon([&] {
      return std::filesystem::exists(journal) && read_session_file(journal).frames.size() == 40;
    })) << replay.snapshot()->failure;
  }
  EXPECT_FALSE(std::filesystem::exists(journal));
}

/// Scans of a log, then an error that no log can cause.
class FailingSource : public FrameSource {
 public:
  FailingSource(std::unique_ptr<FrameSource> log, int scans) : log_(std::move(log)), left_(scans) {}
  std::optional<Frame> next() override {
    if (left_-- == 0) throw std::runtime_error("the laser exploded");
    return log_->next();
  }
  double progress() const override { return 0; }

 private:
  std::unique_ptr<FrameSource> log_;
  int left_;
};

TEST_F(LiveReplay, keeps_the_journal_of_a_run_that_fails_unless_it_has_no_scans) {
  record(40);
  const std::filesystem::path journal = out("session.journal");
  for (const int scans : {0, 30}) {
    {
      const auto open = [&](const LogOptions& options, const LiveControl&) {
        return std::make_unique<FailingSource>(open_log(source_.file, options), scans);
      };
      const Replay replay({"laser", open, journal}, settings_);
      ASSERT_TRUE(soon([&] { return replay.snapshot()->phase == ReplayPhase::kFailed; }));
      EXPECT_EQ(replay.snapshot()->failure,
                scans == 0 ? "the laser exploded"
                           : "the laser exploded. The scans so far are recorded in " + journal.string() +
                                 ". Open this file to map them again.");
    }
    EXPECT_EQ(std::filesystem::exists(journal), scans > 0);
  }
  EXPECT_EQ(read_session_file(journal).frames.size(), 30U);
}

TEST_F(LiveReplay, can_be_closed_while_it_waits) {
  for (const std::size_t scans : {0U, 20U}) {
    record(scans);
    Replay replay(live_stream(source_), settings_);
    wait_for_scans(replay, scans);
    replay.close();
    EXPECT_TRUE(soon([&] { return replay.ended(); })) << scans;
  }
}

TEST_F(LiveReplay, reports_why_a_source_gives_no_map) {
  source_.file = out("missing.log").string();
  const Replay missing(live_stream(source_), settings_);
  ASSERT_TRUE(soon([&] { return missing.snapshot()->phase == ReplayPhase::kFailed; }));
  EXPECT_THAT(missing.snapshot()->failure, HasSubstr("missing.log does not exist"));

  source_.kind = LiveInput::Kind::kTcp;
  Replay silent(live_stream(source_), settings_);
  wait_for(silent, ReplayPhase::kPlaying);
  EXPECT_THAT(silent.live_figures()->notice, HasSubstr("listening on 127.0.0.1:"));
  silent.finish();
  ASSERT_TRUE(soon([&] { return silent.snapshot()->phase == ReplayPhase::kFailed; }));
  EXPECT_THAT(silent.snapshot()->failure, HasSubstr("TCP port 0"));
}

}  // namespace
}  // namespace psi_slam
