// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_session.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <thread>

#include "map/exports/mapped_trajectory.h"
#include "map/exports/run_summary.h"
#include "map/rendering/map_image.h"
#include "map/report/output_folder.h"
#include "map/report/report_html.h"
#include "map/trajectory/trajectory_file.h"
#include "pose_graph/g2o_file.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/grid_map.h"
#include "room_log.h"
#include "same_map.h"
#include "same_results.h"
#include "session/drawn_map.h"
#include "session/edit_journal.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Phase = SessionProgress::Phase;

class MappingSessionTest : public testing::Test {
 protected:
  std::filesystem::path log(const std::vector<std::string>& lines) {
    return write_lines(folder_.path() / "room.log", lines);
  }

  OutputFolder output() { return OutputFolder::prepare(folder_.path() / "out", false); }

  TemporaryFolder folder_;
  Settings settings_;
  const std::atomic<bool> go_on_{false};
};

TEST_F(MappingSessionTest, maps_a_log_to_its_end) {
  MappingSession session(log(room_log_lines()), settings_);
  session.run(go_on_);
  const MappingResult& result = session.result();
  ASSERT_EQ(result.frames.size(), 150U);
  EXPECT_FALSE(result.interrupted);
  EXPECT_FALSE(session.broken_off().has_value());
  const auto off = result.frames[100].map_T_robot - result.frames[0].map_T_robot;
  EXPECT_LT(std::hypot(off.x, off.y), 0.05) << "after one round the robot is back where it began";
}

TEST_F(MappingSessionTest, neither_steps_nor_threads_change_the_result) {
  const auto path = log(room_log_lines());
  settings_.run.threads = 1;
  MappingSession at_once(path, settings_);
  at_once.run(go_on_);
  settings_.run.threads = 3;
  MappingSession stepwise(path, settings_);
  std::size_t steps = 0;
  while (stepwise.step()) ASSERT_EQ(stepwise.mapper().frames().size(), ++steps);
  EXPECT_FALSE(stepwise.step()) << "step() stays false after the end of the log";
  stepwise.finish();
  MappingSession ahead(path, settings_);
  ahead.run(go_on_);
  ASSERT_EQ(at_once.result().frames.size(), steps);
  ASSERT_EQ(ahead.result().frames.size(), steps);
  for (std::size_t i = 0; i < steps; ++i) {
    ASSERT_EQ(at_once.result().frames[i].map_T_robot, stepwise.result().frames[i].map_T_robot) << i;
    ASSERT_EQ(at_once.result().frames[i].map_T_robot, ahead.result().frames[i].map_T_robot) << i;
  }
}

TEST_F(MappingSessionTest, an_early_finish_maps_what_was_read_and_is_marked) {
  MappingSession session(log(room_log_lines()), settings_);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE(session.step());
  session.finish();
  EXPECT_TRUE(session.result().interrupted);
  EXPECT_EQ(session.result().frames.size(), 40U);
  const RunSummary summary = session.export_to(output());
  EXPECT_TRUE(summary.interrupted);
  EXPECT_EQ(read_trajectory(folder_.path() / "out" / "trajectory.tum").size(), 40U);
}

TEST_F(MappingSessionTest, run_stops_on_request) {
  std::atomic<bool> stop{false};
  MappingSession session(log(room_log_lines()), settings_);
  session.set_observer([&](const SessionProgress& progress) { stop = progress.scans == 25; });
  session.run(stop);
  EXPECT_TRUE(session.result().interrupted);
  EXPECT_EQ(session.result().frames.size(), 25U);
}

TEST_F(MappingSessionTest, a_stop_cuts_the_final_search_short) {
  std::atomic<bool> stop{false};
  double share = 0;
  MappingSession session(log(room_log_lines()), settings_);
  session.set_observer([&](const SessionProgress& progress) {
    if (progress.phase != Phase::kFinalSearch) return;
    stop = true;
    share = progress.share;
  });
  session.run(stop);
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 1) << "the final loop search stops before its end";
  EXPECT_EQ(session.result().frames.size(), 150U);
  EXPECT_TRUE(session.result().interrupted);
  const RunSummary summary = session.export_to(output());
  EXPECT_TRUE(summary.interrupted);
  EXPECT_TRUE(summary.final_search_cut_short);
}

TEST_F(MappingSessionTest, an_observer_that_throws_ends_the_final_search) {
  MappingSession session(log(room_log_lines()), settings_);
  session.set_observer([&](const SessionProgress& progress) {
    if (progress.phase == Phase::kFinalSearch) throw std::runtime_error("no more");
  });
  EXPECT_THROW(session.run(go_on_), std::runtime_error);
  EXPECT_TRUE(session.finished());
  EXPECT_TRUE(session.result().interrupted);
  EXPECT_EQ(session.result().frames.size(), 150U);
  EXPECT_TRUE(session.export_to(output()).interrupted);
}

TEST_F(MappingSessionTest, an_observer_of_poses_that_throws_loses_no_scan) {
  const auto path = log(room_log_lines());
  MappingSession undisturbed(path, settings_);
  undisturbed.run(go_on_);
  {
    MappingSession session(path, settings_);
    session.start_journal(folder_.path() / "journal");
    std::size_t told = 0;
    session.set_pose_observer([&](const FrameRecord&) {
      if (told++ % 10 < 2) throw std::runtime_error("no more");
    });
    EXPECT_THROW(session.step(), std::runtime_error);
    session.save(folder_.path() / "one_scan");
    std::size_t failures = 1;
    for (bool more = true; more;) {
      try {
        more = session.step();
      } catch (const std::runtime_error&) {
        ++failures;
      }
    }
    EXPECT_EQ(failures, 30U);
    session.save(folder_.path() / "all_scans");
    session.finish();
    expect_same_map(undisturbed.result(), session.result());
  }
  EXPECT_THAT(read_session_file(folder_.path() / "one_scan").frames, SizeIs(1));
  EXPECT_THAT(read_session_file(folder_.path() / "all_scans").frames, SizeIs(150));
  EXPECT_THAT(read_session_file(folder_.path() / "journal").frames, SizeIs(150));
}

TEST_F(MappingSessionTest, a_stop_after_the_end_does_not_mark_the_result) {
  for (const Phase phase : {Phase::kMapping, Phase::kFinalSearch}) {
    settings_.mapper.back_end.final_search.passes = phase == Phase::kMapping ? 0 : 2;
    std::atomic<bool> stop{false};
    MappingSession session(log(room_log_lines(60)), settings_);
    session.set_observer([&](const SessionProgress& progress) {
      const bool all_done = progress.phase == Phase::kMapping ? progress.scans == 60 : progress.share == 1;
      if (progress.phase == phase && all_done) stop = true;
    });
    session.run(stop);
    EXPECT_TRUE(stop);
    EXPECT_FALSE(session.result().interrupted);
    EXPECT_EQ(session.result().frames.size(), 60U);
  }
}

TEST_F(MappingSessionTest, a_program_replaces_results_by_force) {
  MappingSession session(log(room_log_lines(10)), settings_);
  session.step();
  session.finish();
  session.export_to(folder_.path() / "out");
  try {
    session.export_to(folder_.path() / "out");
    FAIL() << "the results were replaced";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("replace the results in it with force = true"));
  }
  session.export_to(folder_.path() / "out", true);
}

TEST_F(MappingSessionTest, reports_its_progress) {
  std::vector<Phase> phases;
  double share = 0;
  MappingSession session(log(room_log_lines(60)), settings_);
  session.set_observer([&](const SessionProgress& progress) {
    if (phases.empty() || phases.back() != progress.phase) {
      EXPECT_EQ(share, phases.empty() ? 0 : 1) << "a phase ends with a share of 1";
      phases.push_back(progress.phase);
      share = 0;
    }
    EXPECT_GE(progress.share, share);
    share = progress.share;
    EXPECT_GT(progress.elapsed_s, 0);
    EXPECT_EQ(progress.remaining_s.has_value(), share > 0);
    EXPECT_GE(progress.remaining_s.value_or(0), 0);
  });
  session.run(go_on_);
  session.export_to(output());
  EXPECT_THAT(phases, ElementsAre(Phase::kMapping, Phase::kFinalSearch, Phase::kWriting));
}

TEST_F(MappingSessionTest, pauses_by_the_observer_do_not_count_as_work) {
  using Clock = std::chrono::steady_clock;
  Clock::duration held{};
  double elapsed_s = 0;
  MappingSession session(log(room_log_lines(60)), settings_);
  session.set_observer([&](const SessionProgress& progress) {
    const auto from = Clock::now();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    elapsed_s = progress.elapsed_s;
    held += Clock::now() - from;
  });
  const auto start = Clock::now();
  session.run(go_on_);
  const Clock::duration worked = Clock::now() - start - held;
  EXPECT_GT(elapsed_s, 0);
  EXPECT_LE(elapsed_s, std::chrono::duration<double>(worked).count());
  double stages_s = 0;
  for (const StageTiming& stage : session.result().stages) stages_s += stage.total_s;
  EXPECT_LE(stages_s, std::chrono::duration<double>(worked).count());
}

TEST_F(MappingSessionTest, maps_a_damaged_log_up_to_the_damage) {
  auto lines = room_log_lines(60);
  lines.resize(40);
  const auto path = log(lines);
  std::ofstream(path, std::ios::app) << "FLASER 181 1.0 2.0";
  MappingSession session(path, settings_);
  session.run(go_on_);
  ASSERT_TRUE(session.broken_off().has_value());
  EXPECT_THAT(*session.broken_off(), HasSubstr("room.log:41"));
  EXPECT_FALSE(session.result().interrupted) << "a damaged log is not an interruption";
  EXPECT_EQ(session.result().broken_off, session.broken_off());
  EXPECT_EQ(session.result().frames.size(), 40U);
  const RunSummary summary = session.export_to(output());
  EXPECT_FALSE(summary.interrupted);
  EXPECT_EQ(summary.broken_off, session.broken_off());
}

TEST_F(MappingSessionTest, skips_a_malformed_line_with_a_warning) {
  auto lines = room_log_lines(60);
  lines[40] = "FLASER 181 1.0 2.0";
  for (const int threads : {1, 2}) {
    settings_.run.threads = threads;
    MappingSession session(log(lines), settings_);
    session.run(go_on_);
    EXPECT_FALSE(session.broken_off().has_value());
    EXPECT_FALSE(session.result().interrupted);
    EXPECT_EQ(session.result().frames.size(), 59U);
    EXPECT_EQ(session.skipped_lines().count, 1U);
    EXPECT_THAT(session.run_info().warnings, ElementsAre(HasSubstr("room.log:41")));
  }
}

TEST_F(MappingSessionTest, rejects_a_log_with_malformed_scans) {
  auto lines = room_log_lines(5);
  for (std::string& line : lines) line = "FLASER 181 1.0 2.0";
  const auto path = log(lines);
  EXPECT_THAT(sentence_of([&] { MappingSession(path, settings_).run(go_on_); }), HasSubstr("room.log:1:"));
}

TEST_F(MappingSessionTest, rejects_a_log_without_any_return) {
  auto lines = room_log_lines(5);
  for (std::string& line : lines) line = with_ranges(line, 0, kRoomBeams, std::to_string(kRoomNoReturn_m));
  const auto path = log(lines);
  EXPECT_THAT(sentence_of([&] { MappingSession(path, settings_).run(go_on_); }),
              HasSubstr("none of its 5 scans has a return"));
}

TEST_F(MappingSessionTest, accepts_single_scans_without_return) {
  auto lines = room_log_lines(60);
  for (const std::size_t blind : {0U, 1U, 30U, 31U, 32U, 59U})
    lines[blind] = with_ranges(lines[blind], 0, kRoomBeams, "nan");
  MappingSession session(log(lines), settings_);
  session.run(go_on_);
  EXPECT_EQ(session.result().frames.size(), 60U);
  const auto end = session.result().frames[58].map_T_robot - session.result().frames[2].map_T_robot;
  const auto truth = room_pose(2 * M_PI * 58 / 100) - room_pose(2 * M_PI * 2 / 100);
  EXPECT_LT(std::hypot(end.x - truth.x, end.y - truth.y), 0.1);
}

TEST_F(MappingSessionTest, warns_of_unmatched_scans_when_finished_and_resumed) {
  auto lines = room_log_lines(60);
  for (const std::size_t blind : {0U, 30U, 31U, 32U})
    lines[blind] = with_ranges(lines[blind], 0, kRoomBeams, "nan");
  MappingSession session(log(lines), settings_);
  while (session.step()) {
  }
  EXPECT_THAT(session.warnings(), IsEmpty());
  session.finish();
  const auto warns = ElementsAre(HasSubstr("of 60 scans matched no local map and were placed by odometry"));
  EXPECT_THAT(session.warnings(), warns);
  EXPECT_THAT(session.run_info().warnings, warns);
  const auto file = folder_.path() / "room.session";
  session.save(file);
  MappingSession resumed(SessionInput::of_file(file), settings_);
  resumed.run(go_on_);
  EXPECT_EQ(resumed.warnings(), session.warnings());
  for (std::size_t i = 0; i < 60; ++i)
    EXPECT_EQ(resumed.result().frames[i].match, session.result().frames[i].match) << "frame " << i;
}

TEST_F(MappingSessionTest, checks_settings_and_log_before_mapping) {
  EXPECT_THAT(sentence_of([&] { MappingSession("/missing/room.log", settings_); }),
              HasSubstr("/missing/room.log does not exist"));
  settings_.mapper.back_end.psi.psi_1 = 50;
  EXPECT_THAT(sentence_of([&] { MappingSession("/missing/room.log", settings_); }),
              HasSubstr("psi.psi_1 = 50 must not be more than"));
}

TEST_F(MappingSessionTest, exports_the_graph_and_the_figures_of_the_whole_run) {
  settings_.mapper.front_end.node_distance_m = 0.2;
  settings_.run.threads = 1;  // with more, stages overlap and may add up to more than wall_s
  MappingSession session(log(room_log_lines(60)), settings_);
  session.run(go_on_);
  const RunSummary summary = session.export_to(output());
  const PoseGraphFile written = read_pose_graph(folder_.path() / "out" / "graph.g2o");
  EXPECT_EQ(written.graph.num_nodes(), summary.nodes);
  EXPECT_EQ(summary.nodes, session.result().node_frames.size());
  EXPECT_NEAR(summary.log.duration_s, 59 * 0.2, 1e-6);
  EXPECT_NEAR(summary.real_time_factor, summary.log.duration_s / summary.wall_s, 1e-9);
  std::vector<std::string> stages;
  double stages_s = 0;
  for (const StageTiming& stage : session.result().stages) {
    stages.push_back(stage.name);
    stages_s += stage.total_s;
  }
  EXPECT_EQ(stages.front(), "read log");
  EXPECT_EQ(stages.back(), "write results");
  EXPECT_LT(stages_s, summary.wall_s);
  EXPECT_EQ(session.run_info().log_name, "room.log");
  EXPECT_EQ(session.run_info().settings.at("front_end.node_distance_m"), "0.2");
}

TEST_F(MappingSessionTest, draws_and_reads_what_it_exports_without_writing) {
  settings_.map_frame.align = "90";
  settings_.map_frame.origin_x_m = 3;
  MappingSession session(log(room_log_lines()), settings_);
  session.run(go_on_);
  const mrpt::math::TPose2D before = session.result().frames[100].map_T_robot;
  const DrawnMap drawn = session.draw();
  std::string poses;
  session.read_exported([&](const MappingResult& result) {
    poses = tum_text(trajectory_of(result.frames));
    EXPECT_NE(result.frames[100].map_T_robot, before);
  });
  EXPECT_EQ(session.result().frames[100].map_T_robot, before);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out"));

  const OutputFolder folder = output();
  const RunSummary summary = session.export_to(folder);
  EXPECT_EQ(poses, read_file(folder.path() / "trajectory.tum"));
  EXPECT_EQ(summary_without_times(summary_json(session.result(), session.run_info(), drawn.summary)),
            summary_without_times(read_file(folder.path() / "summary.json")));
  write_map_image(folder_.path() / "drawn.png", *drawn.grid);
  EXPECT_EQ(read_file(folder_.path() / "drawn.png"), read_file(folder.path() / "map.png"));
}

TEST_F(MappingSessionTest, report_summary_and_caller_get_the_same_times) {
  MappingSession session(log(room_log_lines(60)), settings_);
  session.run(go_on_);
  const RunSummary summary = session.export_to(output());
  const std::filesystem::path out = folder_.path() / "out";
  const MappingResult& result = session.result();
  const auto grid = draw_grid_map(result.log, mapped_poses(result), settings_.map);
  EXPECT_EQ(read_file(out / "summary.json"), summary_json(result, session.run_info(), summary));
  EXPECT_TRUE(read_file(out / "report.html") == report_html(result, session.run_info(), summary, *grid));
  EXPECT_THAT(read_file(out / "report.html"), HasSubstr("<th>write results</th>"));
}

class MappingSessionEditsTest : public MappingSessionTest {
 protected:
  static LoopEdit delete_of(const LoopRecord& loop) {
    return {LoopEdit::Kind::kDelete, loop.frame, loop.local_map};
  }

  static const LoopRecord& accepted(const std::vector<LoopRecord>& loops) {
    for (const LoopRecord& loop : loops)
      if (loop.state == LoopState::kAccepted) return loop;
    throw std::logic_error("no loop was closed");
  }

  /// Maps the log with the edits that an earlier export left in the folder `like`.
  std::filesystem::path mapped_by_file(const std::filesystem::path& path, const std::filesystem::path& like) {
    MappingSession session(path, settings_);
    session.add_edits(EditJournal::read(like / "loops.edits"));
    session.run(go_on_);
    EXPECT_THAT(session.unmet_edits(), IsEmpty());
    session.export_to(OutputFolder::prepare(folder_.path() / "by_file", false));
    return folder_.path() / "by_file";
  }
};

TEST_F(MappingSessionEditsTest, interactive_edits_equal_edits_from_a_file) {
  const auto path = log(room_log_lines(220));
  MappingSession session(path, settings_);
  session.stay_open();
  while (session.step()) {
    const std::size_t scans = session.mapper().frames().size();
    if (scans == 150) session.edit(delete_of(accepted(session.mapper().loops())));
    if (scans == 180) {
      LoopEdit match{LoopEdit::Kind::kMatch, session.mapper().loops().back().frame,
                     session.mapper().loops().back().local_map};
      match.matcher = MatcherKind::kGa;
      session.edit(match);
    }
  }
  session.finish();
  EXPECT_TRUE(session.finished());
  const LoopEdit late = delete_of(accepted(session.result().loops));
  EXPECT_EQ(session.edit(late).state, LoopEditOutcome::State::kDone);
  EXPECT_FALSE(session.finished());
  session.finish();
  const LoopEdit later = delete_of(accepted(session.result().loops));
  session.edit(later);
  session.edit({LoopEdit::Kind::kRestore, late.frame, late.local_map});
  session.finish();
  EXPECT_FALSE(session.result().interrupted);
  session.export_to(output());
  const std::filesystem::path out = folder_.path() / "out";
  EXPECT_THAT(EditJournal::read(out / "loops.edits").edits(), SizeIs(5));
  expect_same_results(out, mapped_by_file(path, out));
}

TEST_F(MappingSessionEditsTest, change_the_map) {
  const auto path = log(room_log_lines());
  MappingSession untouched(path, settings_);
  untouched.run(go_on_);
  untouched.export_to(output());
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "out" / "loops.edits")) << "there were no edits";
  EditJournal edits;
  for (const LoopRecord& loop : untouched.result().loops) edits.add({delete_of(loop), {}});
  MappingSession edited(path, settings_);
  edited.add_edits(edits);
  edited.run(go_on_);
  for (const LoopRecord& loop : edited.result().loops)
    EXPECT_NE(loop.state, LoopState::kAccepted) << loop.frame << ' ' << loop.local_map;
  const RunSummary summary = edited.export_to(OutputFolder::prepare(folder_.path() / "edited", false));
  EXPECT_EQ(summary.loops.accepted, 0U);
  EXPECT_GT(summary.loops.by_hand, 0U);
}

TEST_F(MappingSessionEditsTest, reports_edits_that_could_not_be_made) {
  EditJournal edits;
  edits.add({{LoopEdit::Kind::kDelete, 5, 0}, {EditTime::Kind::kAfterScan, 1000}});
  edits.add({{LoopEdit::Kind::kForce, 7, 99}, {}});
  MappingSession session(log(room_log_lines(60)), settings_);
  session.add_edits(edits);
  session.run(go_on_);
  EXPECT_THAT(session.unmet_edits(),
              ElementsAre("delete the loop of scan 5 with local map 0: scan 5 is part of local map 0",
                          HasSubstr("force the loop of scan 7 with local map 99: ")));
  EXPECT_THAT(session.run_info().warnings, SizeIs(2)) << "the report contains the warnings too";
}

TEST_F(MappingSessionEditsTest, zones_that_contradict_earlier_ones_are_refused_before_mapping) {
  const auto zone = [](const std::string& limit) {
    return EditJournal::parse("slow polygon=0,0;1,0;1,1 " + limit, "my.edits");
  };
  MappingSession session(log(room_log_lines(60)), settings_);
  session.add_edits(zone("percent=40"));
  EXPECT_THAT(sentence_of([&] { session.add_edits(zone("max_speed_mps=0.3")); }),
              HasSubstr("expected one of them"));
  EXPECT_THAT(session.edits().map_edits(), SizeIs(1));
}

}  // namespace
}  // namespace psi_slam
