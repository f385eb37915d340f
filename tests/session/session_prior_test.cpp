// SPDX-License-Identifier: BSD-3-Clause
// Tests mapping sessions with a prior map.
#include "session/session_prior.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "localization/reference_map.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/user_error.h"
#include "room_drawing.h"
#include "room_log.h"
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

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Phase = SessionProgress::Phase;
namespace fs = std::filesystem;

constexpr int kScans = 60;
constexpr int kScansOfRound = 50;
const std::vector<RoomWall> kWallsOfRoom = {{0, 0, 12, 0},    {12, 0, 12, 8}, {12, 8, 7, 8}, {7, 8, 7, 9.5},
                                            {7, 9.5, 4, 9.5}, {4, 9.5, 4, 8}, {4, 8, 0, 8},  {0, 8, 0, 0}};

class SessionPriorTest : public testing::Test {
 protected:
  void SetUp() override {
    write_lines(log_, room_log_lines(kScans, kScansOfRound));
    draw_room(kWallsOfRoom);
    settings_.prior.map = (folder_.path() / "plan" / "map.yaml").string();
  }

  /// Writes walls as a plan of 0.05 m cells.
  void draw_room(const std::vector<RoomWall>& walls) const {
    constexpr int kWidth = 260;
    constexpr int kHeight = 210;
    std::string cells(std::size_t{kWidth} * kHeight, '\xFE');
    for (const RoomWall& wall : walls) {
      const int steps = static_cast<int>(100 * std::hypot(wall.x1 - wall.x0, wall.y1 - wall.y0));
      for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        const int x = static_cast<int>(std::floor((wall.x0 + share * (wall.x1 - wall.x0) + 0.5) / 0.05));
        const int y = static_cast<int>(std::floor((wall.y0 + share * (wall.y1 - wall.y0) + 0.5) / 0.05));
        cells[static_cast<std::size_t>((kHeight - 1 - y) * kWidth + x)] = '\0';
      }
    }
    fs::create_directories(folder_.path() / "plan");
    write_file(folder_.path() / "plan" / "map.pgm", "P5\n260 210\n255\n" + cells);
    write_file(folder_.path() / "plan" / "map.yaml",
               "image: map.pgm\nresolution: 0.05\norigin: [-0.5, -0.5, 0]\nnegate: 0\n"
               "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  }

  fs::path export_of(MappingSession& session, const std::string& name) const {
    session.export_to(OutputFolder::prepare(folder_.path() / name, false));
    return folder_.path() / name;
  }

  /// Chooses the drawing of the room as the prior map.
  void use_drawing() {
    settings_.prior.map = (folder_.path() / "room.dxf").string();
    settings_.prior.layers = "WALLS";
    write_file(settings_.prior.map, room_drawing(kMillimetres));
  }

  /// Maps the first `scans` scans and saves the session.
  void save_after(int scans, const EditJournal& edits = {}) {
    MappingSession session(log_, settings_);
    session.add_edits(edits);
    for (int i = 0; i < scans; ++i) session.step();
    session.finish();
    session.save(saved_);
  }

  SessionInput resumed(const fs::path& log = {}) const {
    return SessionInput(std::make_shared<const SessionRecording>(read_session_file(saved_)), log);
  }

  /// Maps the saved session again. Returns the sentences about a prior map that has changed.
  std::vector<std::string> sentences_of_change() const {
    MappingSession session(resumed(), settings_);
    session.run(go_on_);
    std::vector<std::string> sentences;
    for (const std::string& warning : session.warnings())
      if (warning.find("has changed") != std::string::npos) sentences.push_back(warning);
    return sentences;
  }

  /// Distance of the last pose in the exported frame from its true place in the room.
  static double off_m(MappingSession& session) {
    double off = 0;
    session.read_exported([&](const MappingResult& result) {
      const mrpt::math::TPose2D truth =
          room_pose(2 * M_PI * static_cast<double>(result.frames.size() - 1) / kScansOfRound);
      const mrpt::math::TPose2D& pose = result.frames.back().map_T_robot;
      off = std::hypot(pose.x - truth.x, pose.y - truth.y);
    });
    return off;
  }

  TemporaryFolder folder_;
  const fs::path saved_ = folder_.path() / "saved.session";
  const fs::path log_ = folder_.path() / "room.log";
  Settings settings_;
  const std::atomic<bool> go_on_{false};
};

TEST_F(SessionPriorTest, the_search_is_a_phase_of_its_own) {
  std::vector<Phase> phases;
  double share = 1;
  MappingSession session(log_, settings_);
  session.set_observer([&](const SessionProgress& progress) {
    if (phases.empty() || phases.back() != progress.phase) {
      EXPECT_EQ(share, 1) << "a phase ends with a share of 1";
      phases.push_back(progress.phase);
      share = 0;
    }
    EXPECT_GE(progress.share, share);
    share = progress.share;
  });
  session.run(go_on_);
  export_of(session, "out");
  EXPECT_THAT(phases,
              ElementsAre(Phase::kMapping, Phase::kPriorSearch, Phase::kFinalSearch, Phase::kWriting));
  EXPECT_THAT(session.result().contradictions, Each(Not(HasSubstr("left out"))));
  EXPECT_LT(off_m(session), 0.06);
}

TEST_F(SessionPriorTest, a_stop_cuts_the_search_short_and_the_map_keeps_its_own_frame) {
  std::atomic<bool> stop{false};
  double share = -1;
  MappingSession session(log_, settings_);
  session.stay_open();
  session.set_observer([&](const SessionProgress& progress) {
    if (progress.phase != Phase::kPriorSearch) return;
    stop = progress.share > 0;
    share = progress.share;
  });
  session.run(stop);
  EXPECT_GT(share, 0);
  EXPECT_LT(share, 1);
  EXPECT_TRUE(session.result().interrupted);
  EXPECT_EQ(session.result().frames.size(), static_cast<std::size_t>(kScans));
  EXPECT_THAT(session.result().contradictions,
              ElementsAre(AllOf(HasSubstr("map.yaml: this map is left out"), HasSubstr("was interrupted"))));
  EXPECT_GT(off_m(session), 1);
  EXPECT_TRUE(session.export_to(OutputFolder::prepare(folder_.path() / "out", false)).interrupted);
  session.set_observer({});
  session.reopen();
  session.finish();
  EXPECT_THAT(session.result().contradictions, IsEmpty());
  EXPECT_FALSE(session.result().interrupted);
  EXPECT_LT(off_m(session), 0.06);
}

TEST_F(SessionPriorTest, an_export_never_replaces_the_prior_map) {
  const std::string image = read_file(folder_.path() / "plan" / "map.pgm");
  MappingSession session(log_, settings_);
  session.run(go_on_);
  try {
    session.export_to(OutputFolder::prepare(folder_.path() / "plan", true));
    FAIL() << "the prior map may be replaced";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("prior.map is " + settings_.prior.map),
                                    HasSubstr("Choose another folder for the results")));
  }
  EXPECT_EQ(read_file(folder_.path() / "plan" / "map.pgm"), image);
  EXPECT_FALSE(fs::exists(folder_.path() / "plan" / "graph.g2o"));
  export_of(session, "out");
}

TEST_F(SessionPriorTest, a_resumed_session_names_a_changed_file_once) {
  save_after(kScans);
  EXPECT_EQ(read_session_file(saved_).facts.prior->map, settings_.prior.map);
  EXPECT_THAT(sentences_of_change(), IsEmpty());
  write_file(folder_.path() / "plan" / "map.yaml",
             read_file(folder_.path() / "plan" / "map.yaml") + "mode: trinary\n");
  EXPECT_THAT(sentences_of_change(),
              ElementsAre(AllOf(HasSubstr("map.yaml: this prior map has changed since the session was saved"),
                                HasSubstr("Restore the file"))));
  save_after(kScans);
  EXPECT_THAT(sentences_of_change(), IsEmpty());
  std::string image = read_file(folder_.path() / "plan" / "map.pgm");
  image.back() = '\0';
  write_file(folder_.path() / "plan" / "map.pgm", image);
  EXPECT_THAT(sentences_of_change(), testing::SizeIs(1));
  MappingSession session(resumed(), settings_);
  session.run(go_on_);
  session.save(saved_);
  EXPECT_THAT(sentences_of_change(), IsEmpty()) << "the saved session has the checksum of the changed file";
}

TEST_F(SessionPriorTest, a_changed_drawing_is_named_and_old_sessions_are_not) {
  use_drawing();
  save_after(30);
  write_file(settings_.prior.map, room_drawing(kMillimetres) + "\n");
  EXPECT_THAT(sentences_of_change(), ElementsAre(HasSubstr("room.dxf: this prior map has changed")));
  SessionRecording recording = read_session_file(saved_);
  recording.facts.prior.reset();
  write_session_file(saved_, recording.facts, recording.frames);
  EXPECT_THAT(sentences_of_change(), IsEmpty());
}

TEST_F(SessionPriorTest, an_interrupted_run_is_resumed_to_the_same_bytes) {
  for (const char* name : {"image", "drawing"}) {
    if (std::string(name) == "drawing") use_drawing();
    MappingSession session(log_, settings_);
    session.run(go_on_);
    const fs::path whole = export_of(session, name);
    save_after(35);
    MappingSession again(resumed(log_), settings_);
    again.run(go_on_);
    EXPECT_LT(off_m(again), 0.1);
    expect_same_results(whole, export_of(again, name + std::string("-resumed")));
  }
}

TEST_F(SessionPriorTest, the_cells_of_the_drawn_map_change_no_pose) {
  use_drawing();
  MappingSession fine(log_, settings_);
  fine.run(go_on_);
  settings_.map.resolution_m = 0.1;
  MappingSession coarse(log_, settings_);
  coarse.run(go_on_);
  ASSERT_EQ(fine.result().frames.size(), coarse.result().frames.size());
  for (std::size_t i = 0; i < fine.result().frames.size(); ++i)
    ASSERT_EQ(fine.result().frames[i].map_T_robot, coarse.result().frames[i].map_T_robot) << i;
}

TEST_F(SessionPriorTest, a_session_that_stays_open_is_aligned_again_after_every_edit) {
  write_lines(log_, room_log_lines(110, kScansOfRound));
  MappingSession session(log_, settings_);
  session.stay_open();
  session.run(go_on_);
  const fs::path first = export_of(session, "first");
  session.reopen();
  session.finish();
  expect_same_results(first, export_of(session, "again"));
  const auto& loops = session.result().loops;
  const auto loop = std::find_if(loops.begin(), loops.end(), [](const LoopRecord& candidate) {
    return candidate.state == LoopState::kAccepted;
  });
  ASSERT_NE(loop, loops.end());
  session.edit(LoopEdit{LoopEdit::Kind::kDelete, loop->frame, loop->local_map});
  session.edit(EditJournal::parse("wall line=9,3;9,5 width_m=0.2\n", "my.edits").map_edits().front());
  session.finish();
  const fs::path edited = export_of(session, "edited");
  EXPECT_LT(off_m(session), 0.06);
  EXPECT_NE(read_file(first / "loops.csv"), read_file(edited / "loops.csv"));
  session.save(saved_);
  MappingSession resumed_session(resumed(), settings_);
  resumed_session.run(go_on_);
  expect_same_results(edited, export_of(resumed_session, "resumed"));
  MappingSession from_edits(log_, settings_);
  from_edits.add_edits(EditJournal::read(edited / "loops.edits"));
  from_edits.run(go_on_);
  expect_same_results(edited, export_of(from_edits, "from-edits"));
}

TEST_F(SessionPriorTest, a_wall_drawn_in_the_frame_of_the_run_follows_it_into_the_frame_of_the_prior_map) {
  const std::string prior = std::exchange(settings_.prior.map, "");
  const mrpt::math::TPose2D room_T_run = room_pose(0);
  const auto in_run = [&](double x, double y) { return room_T_run.inverseComposePoint({x, y}); };
  const mrpt::math::TPoint2D from = in_run(9, 3);
  const mrpt::math::TPoint2D to = in_run(9, 5);
  MappingSession alone(log_, settings_);
  alone.add_edits(EditJournal::parse("wall line=" + std::to_string(from.x) + ',' + std::to_string(from.y) +
                                         ';' + std::to_string(to.x) + ',' + std::to_string(to.y) +
                                         " width_m=0.2\n",
                                     "my.edits"));
  alone.run(go_on_);
  const fs::path before = export_of(alone, "alone");
  settings_.prior.map = prior;
  MappingSession aligned(log_, settings_);
  aligned.add_edits(EditJournal::read(before / "loops.edits"));
  aligned.run(go_on_);
  const DrawnMap drawn = aligned.draw();
  for (const float y : {3.2F, 4.0F, 4.8F}) {
    EXPECT_LT(drawn.grid->getPos(9.05F, y), 0.3F) << y;
    EXPECT_GT(drawn.grid->getPos(9.5F, y), 0.7F) << y;
  }
}

TEST_F(SessionPriorTest, the_drawing_of_a_run_is_a_prior_map_as_it_is) {
  settings_.prior.map.clear();
  MappingSession first(log_, settings_);
  first.run(go_on_);
  settings_.prior.map = (export_of(first, "first") / "map.dxf").string();
  MappingSession second(log_, settings_);
  second.run(go_on_);
  EXPECT_THAT(second.result().contradictions, IsEmpty());
  const PriorFit fit = second.draw().summary.prior.value();
  EXPECT_TRUE(fit.is_accepted);
  EXPECT_GT(fit.places, 3U);
  EXPECT_EQ(fit.fitting, fit.places);
  EXPECT_EQ(second.result().knowledge.used, 0U) << "places that were found are no statements";
  EXPECT_NEAR(off_m(second), off_m(first), 0.06);
}

TEST_F(SessionPriorTest, a_drawing_that_does_not_fit_is_refused_with_its_layers) {
  use_drawing();
  settings_.prior.metres_per_unit = 0.0003;
  MappingSession session(log_, settings_);
  session.run(go_on_);
  EXPECT_THAT(session.result().contradictions,
              ElementsAre(HasSubstr("or name the layers with walls by prior.layers (this drawing has: "
                                    "DIMENSIONS, WALLS)")));
  EXPECT_FALSE(session.draw().summary.prior.value().is_accepted);
}

TEST_F(SessionPriorTest, sightings_of_marks_without_a_place_are_allowed) {
  std::string lines;
  for (const int scan : {5, 55}) {
    const mrpt::math::TPoint2D mark =
        room_pose(2 * M_PI * scan / kScansOfRound).inverseComposePoint({9.0, 7.0});
    lines += "seen name=a time_s=" + std::to_string(1000 + 0.2 * scan) +
             " ahead_m=" + std::to_string(mark.x) + " left_m=" + std::to_string(mark.y) + " sigma_m=0.02\n";
  }
  MappingSession session(log_, settings_);
  session.add_edits(EditJournal::parse(lines, "my.edits"));
  session.run(go_on_);
  EXPECT_THAT(session.result().contradictions,
              Each(Not(AnyOf(HasSubstr("left out"), HasSubstr("my.edits")))));
  EXPECT_LT(off_m(session), 0.06);
}

TEST_F(SessionPriorTest, an_extended_map_lacks_walls_that_are_gone_and_has_new_ones) {
  std::vector<RoomWall> walls = kWallsOfRoom;
  walls.push_back({9, 3, 9, 5});
  draw_room(walls);
  settings_.prior.extend = true;
  MappingSession session(log_, settings_);
  session.run(go_on_);
  const DrawnMap drawn = session.draw();
  EXPECT_THAT(session.warnings(), Contains(AllOf(HasSubstr("the scans see free space at 1 wall of this map"),
                                                 HasSubstr("The exported map shows free space there"),
                                                 Not(HasSubstr("Correct the map")))));
  for (const float y : {3.2F, 4.0F, 4.8F}) EXPECT_GT(drawn.grid->getPos(9.02F, y), 0.7F) << y;
  const mrpt::maps::COccupancyGridMap2D prior = read_map_file(settings_.prior.map);
  std::size_t standing = 0;
  std::size_t pillar = 0;
  for (int y = 0; y < static_cast<int>(drawn.grid->getSizeY()); ++y) {
    for (int x = 0; x < static_cast<int>(drawn.grid->getSizeX()); ++x) {
      const float x_m = drawn.grid->idx2x(x);
      const float y_m = drawn.grid->idx2y(y);
      const bool is_wall = drawn.grid->getCell(x, y) < 0.3F;
      const bool is_in_room = x_m > 0.2F && x_m < 11.8F && y_m > 0.2F && y_m < 7.8F;
      const bool was_wall = prior.getPos(x_m, y_m) < 0.3F;
      if (!is_in_room && (was_wall || is_wall)) {
        EXPECT_EQ(is_wall, was_wall) << x_m << ' ' << y_m;
        ++standing;
      }
      if (x_m > 4.7F && x_m < 7.7F && y_m > 2.7F && y_m < 5.3F && is_wall) ++pillar;
    }
  }
  EXPECT_GT(standing, 800U);
  EXPECT_GT(pillar, 30U) << "it was not in the plan";
}

TEST_F(SessionPriorTest, larger_cells_than_those_of_the_prior_map_do_not_extend_it) {
  settings_.prior.extend = true;
  settings_.map.max_cells = 10'000;
  MappingSession session(log_, settings_);
  session.run(go_on_);
  export_of(session, "out");
  EXPECT_THAT(session.warnings(), Contains(AllOf(HasSubstr("map.yaml: this map is not extended"),
                                                 HasSubstr("Increase map.max_cells"))));
}

}  // namespace
}  // namespace psi_slam
