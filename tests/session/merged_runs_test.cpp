// SPDX-License-Identifier: BSD-3-Clause
// Merges two runs through a simulated building into one map and compares it with the truth.
#include <gmock/gmock.h>

#include "../localization/simulated_runs.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "same_results.h"
#include "session/place_run.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;
namespace fs = std::filesystem;

SessionInput input_of(const std::string& name, const std::vector<Frame>& frames) {
  auto recording = std::make_shared<SessionRecording>();
  recording->facts.logs = {{name, name, frames.size()}};
  recording->frames = frames;
  return SessionInput(recording);
}

class MergedRuns : public testing::Test {
 protected:
  std::unique_ptr<MappingSession> merged(const SessionInput& first, const SessionInput& second,
                                         const std::optional<TPose2D>& start = {}) {
    auto session = std::make_unique<MappingSession>(first, settings_);
    session->stay_open();
    session->run(go_on_);
    const MappingResult& mapped = session->result();
    const auto grid = draw_grid_map(mapped.log, mapped_poses(mapped), settings_.map);
    session->begin_run(second, place_run(mapped, *grid, second, settings_, start, go_on_));
    session->run(go_on_);
    return session;
  }

  fs::path export_of(MappingSession& session, const std::string& name) {
    session.export_to(OutputFolder::prepare(folder_.path() / name, false));
    return folder_.path() / name;
  }

  /// Largest distance of a frame from its true position, in metres, with both runs in the frame of the first
  /// scan.
  static double worst_m(const MappingResult& result, const TrueRun& first, const TrueRun& second) {
    double worst = 0;
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
      const bool in_first = i < first.frames.size();
      const TPose2D& world_T_robot =
          in_first ? first.world_T_robot[i] : second.world_T_robot[i - first.frames.size()];
      worst =
          std::max(worst, distance_m(result.frames[i].map_T_robot, world_T_robot - first.world_T_robot[0]));
    }
    return worst;
  }

  TemporaryFolder folder_;
  Settings settings_;
  const std::atomic<bool> go_on_{false};
};

TEST_F(MergedRuns, are_placed_correctly_without_odometry_between_them) {
  const TrueRun first = run_through(5, 1, 150);
  const TrueRun second = run_through(5, 2, 80);
  const auto session = merged(input_of("first", first.frames), input_of("second", second.frames));
  const MappingResult& result = session->result();
  ASSERT_EQ(result.frames.size(), first.frames.size() + second.frames.size());
  ASSERT_EQ(result.later_run_frames, std::vector<std::size_t>{first.frames.size()});
  EXPECT_EQ(unjoined_log(result), std::nullopt);
  const double off_m = worst_m(result, first, second);
  RecordProperty("worst_m", std::to_string(off_m));
  EXPECT_LT(off_m, 0.15);

  const PoseGraph& graph = session->mapper().graph();
  const std::size_t first_node = static_cast<std::size_t>(
      std::lower_bound(result.node_frames.begin(), result.node_frames.end(), first.frames.size()) -
      result.node_frames.begin());
  std::size_t starts = 0;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& constraint = graph.constraint(i);
    if ((constraint.from < first_node) == (constraint.to < first_node)) continue;
    starts += constraint.kind == Constraint::Kind::kRunStart ? 1 : 0;
    EXPECT_TRUE(constraint.kind == Constraint::Kind::kRunStart || constraint.kind == Constraint::Kind::kLoop);
  }
  EXPECT_EQ(starts, 1U);
  const TPose2D begin = result.frames[first.frames.size()].odom_T_robot;
  EXPECT_LT(distance_m(begin, second.world_T_robot[0] - first.world_T_robot[0]), 1)
      << "the odometry of the second run starts at the true start of the run";
}

TEST_F(MergedRuns, mapping_a_saved_session_again_gives_the_same_bytes) {
  const TrueRun first = run_through(5, 1, 60);
  const TrueRun second = run_through(5, 2, 50);
  const auto with_edits = [&](const std::string& name, const TrueRun& run) {
    const SessionInput input = input_of(name, run.frames);
    MappingSession session(input, settings_);
    session.run(go_on_);
    EditJournal edits;
    for (const LoopRecord& loop : session.result().loops)
      if (loop.state == LoopState::kAccepted && loop.frame % 2 == 0) {
        const EditTime times[] = {{}, {EditTime::Kind::kAfterScan, run.frames.size() - 1}};
        edits.add({{LoopEdit::Kind::kDelete, loop.frame, loop.local_map}, times[edits.edits().size() % 2]});
      }
    EXPECT_FALSE(edits.empty()) << name;
    return input.with_edits(edits);
  };
  const auto session = merged(with_edits("first", first), with_edits("second", second));
  const fs::path whole = export_of(*session, "whole");
  session->save(folder_.path() / "both.session");
  settings_.run.threads = 1;
  MappingSession again(SessionInput::of_file(folder_.path() / "both.session"), settings_);
  again.run(go_on_);
  expect_same_results(whole, export_of(again, "again"));
  EXPECT_EQ(again.result().later_run_frames, session->result().later_run_frames);
}

TEST_F(MergedRuns, an_interrupted_recording_is_saved_up_to_there) {
  const TrueRun first = run_through(5, 1, 20);
  TrueRun others = run_through(5, 2, 20);
  ASSERT_GT(others.frames.size(), 60U);
  others.frames.resize(60);
  const std::size_t of_first = first.frames.size();
  SessionRecording recording;
  recording.facts.logs = {{"b.log", "b", 40}, {"c.log", "c", 20}};
  recording.facts.runs = {{40, {}}};
  recording.facts.edits.add({{LoopEdit::Kind::kDelete, 10, 0}, {EditTime::Kind::kAfterScan, 39}});
  recording.facts.edits.add({{LoopEdit::Kind::kDelete, 50, 0}, {EditTime::Kind::kAfterScan, 59}});
  recording.frames = others.frames;
  const SessionInput inner(std::make_shared<const SessionRecording>(recording));
  for (const std::size_t steps : {0U, 30U, 40U}) {
    MappingSession session(input_of("a.log", first.frames), settings_);
    session.stay_open();
    session.run(go_on_);
    session.begin_run(inner, {});
    for (std::size_t i = 0; i < steps; ++i) session.step();
    session.finish();
    session.save(folder_.path() / "part.session");
    const SessionFacts facts = read_session_file(folder_.path() / "part.session").facts;
    ASSERT_EQ(facts.logs.size(), steps == 0 ? 1U : 2U);
    EXPECT_EQ(facts.logs.front().scans, of_first);
    EXPECT_EQ(facts.logs.back().scans, steps == 0 ? of_first : steps);
    EXPECT_EQ(facts.runs.size(), steps == 0 ? 0U : 1U);
    EXPECT_EQ(facts.edits.edits().size(), steps == 0 ? 0U : 1U);
    EXPECT_EQ(facts.logs.back().scans_left, steps == 30);
  }
}

TEST_F(MergedRuns, places_a_short_run_despite_damage_or_further_runs) {
  const TrueRun first = run_through(5, 1, 60);
  const TrueRun second = run_through(5, 2, 12);
  const TrueRun elsewhere = run_through(6, 2, 12);
  MappingSession session(input_of("first", first.frames), settings_);
  session.run(go_on_);
  const MappingResult& mapped = session.result();
  const auto grid = draw_grid_map(mapped.log, mapped_poses(mapped), settings_.map);
  const TPose2D near = second.world_T_robot[0] - first.world_T_robot[0];
  const auto start_of = [&](const SessionRecording& run) {
    const SessionInput input(std::make_shared<const SessionRecording>(run));
    return place_run(mapped, *grid, input, settings_, near, go_on_);
  };
  SessionRecording run;
  run.frames.assign(second.frames.begin(), second.frames.begin() + 6);
  run.facts.logs = {{"second", "second", 6}};
  const RunStart alone = start_of(run);
  SessionRecording broken = run;
  broken.facts.logs[0].broken_off = "second.log:7 is cut off";
  EXPECT_EQ(start_of(broken).node_T_robot, alone.node_T_robot);
  SessionRecording with_another = run;
  with_another.facts.runs = {{6, {}}};
  with_another.frames.insert(with_another.frames.end(), elsewhere.frames.begin(), elsewhere.frames.end());
  with_another.facts.logs[0].scans = with_another.frames.size();
  EXPECT_EQ(start_of(with_another).node_T_robot, alone.node_T_robot);
}

TEST_F(MergedRuns, the_search_for_the_start_reports_progress_and_can_stop) {
  const TrueRun first = run_through(5, 1, 60);
  const SessionInput elsewhere = input_of("elsewhere", run_through(6, 2, 12).frames);
  MappingSession session(input_of("first", first.frames), settings_);
  session.run(go_on_);
  const MappingResult& mapped = session.result();
  const auto grid = draw_grid_map(mapped.log, mapped_poses(mapped), settings_.map);
  std::vector<double> shares;
  std::atomic<bool> stop{false};
  const auto place = [&] {
    place_run(mapped, *grid, elsewhere, settings_, {}, stop, [&](double share) {
      shares.push_back(share);
      stop = share > 0.5;
    });
  };
  try {
    place();
    ADD_FAILURE() << "the search was not interrupted";
  } catch (const SystemFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("interrupted before a run was placed in the map"));
  }
  ASSERT_GT(shares.size(), 5U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LT(shares.front(), 0.2);
  EXPECT_GT(shares.back(), 0.5);
  EXPECT_LT(shares.back(), 0.7) << "the search ends at once";
}

TEST_F(MergedRuns, rejects_runs_of_different_buildings) {
  const SessionInput first = input_of("first", run_through(5, 1, 60).frames);
  const SessionInput elsewhere = input_of("elsewhere", run_through(6, 2, 12).frames);
  EXPECT_THAT(sentence_of([&] { merged(first, elsewhere); }),
              HasSubstr("elsewhere cannot be placed in the map"));
  EXPECT_THAT(sentence_of([&] { merged(first, elsewhere, TPose2D(3, 0, 1)); }),
              HasSubstr("elsewhere does not begin near --start"));
}

}  // namespace
}  // namespace psi_slam
