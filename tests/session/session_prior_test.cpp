// SPDX-License-Identifier: BSD-3-Clause
// Tests mapping sessions with a prior map.
#include "session/session_prior.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "psi_slam/mapping_session.h"
#include "psi_slam/user_error.h"
#include "report/output_folder.h"
#include "room_log.h"
#include "same_results.h"
#include "session/drawn_map.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Phase = SessionProgress::Phase;
namespace fs = std::filesystem;

constexpr int kScans = 60;
constexpr int kScansOfRound = 50;

class SessionPriorTest : public testing::Test {
 protected:
  void SetUp() override {
    write_lines(log_, room_log_lines(kScans, kScansOfRound));
    draw_room({{0, 0, 12, 0},
               {12, 0, 12, 8},
               {12, 8, 7, 8},
               {7, 8, 7, 9.5},
               {7, 9.5, 4, 9.5},
               {4, 9.5, 4, 8},
               {4, 8, 0, 8},
               {0, 8, 0, 0}});
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

}  // namespace
}  // namespace psi_slam
