// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

#include <gmock/gmock.h>

#include <functional>
#include <set>

#include "member_count.h"
#include "psi_slam/user_error.h"
#include "config/apply_settings.h"
#include "config/ini_file.h"
#include "config/option_listing.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class SettingsTest : public testing::Test {
 protected:
  SettingsTest() { describe(table_, settings_); }

  std::size_t described() const {
    std::size_t options = 0;
    for (const OptionSection& section : table_.sections()) options += section.options.size();
    return options;
  }

  /// The sentence with which these settings are refused; "" if they are not.
  std::string refusal(const std::vector<std::string>& assignments) {
    for (const std::string& assignment : assignments) apply_override(assignment, table_);
    try {
      check(settings_);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }

  Settings settings_;
  OptionTable table_;
};

TEST_F(SettingsTest, every_member_of_every_struct_is_described) {
  const std::size_t log =
      member_count<LogOptions>() - 1 + member_count<LaserMount>();  // one stands for the pose
  const std::size_t front_end = member_count<FrontEndOptions>() - 3 + member_count<ScanFilterOptions>() +
                                member_count<LocalMapOptions>() + member_count<RefinementOptions>();
  const std::size_t matcher = member_count<MatcherOptions>() - 1 + member_count<RefinementOptions>();
  const std::size_t loops = member_count<LoopClosureOptions>() - 3 + member_count<LoopCandidateOptions>() -
                            1 + member_count<SearchExtent>() + member_count<LoopVerificationOptions>() +
                            member_count<ScanContextOptions>() + member_count<LoopConsensusOptions>() +
                            member_count<FinalSearchOptions>() + member_count<JointRefinementOptions>() - 1 +
                            member_count<SurfaceAlignmentOptions>();
  // The mapper makes no constraints of odometry.
  const std::size_t solver = member_count<PoseAdjustmentOptions>() - 3 + 2 * member_count<RobustKernel>();
  const std::size_t choice = member_count<PsiOptions>() + member_count<GeneticOptions>() - 3 +
                             member_count<PaperGeneticOptions>() + member_count<MemeticGeneticOptions>() +
                             member_count<CoarseCellOptions>();
  // Of MapperOptions nine are structs, and the seed and the threads are those of RunOptions.
  const std::size_t mapper = member_count<MapperOptions>() - 4 + member_count<BackEndOptions>() - 8 +
                             choice + front_end + matcher + loops + solver;
  const std::size_t files =
      member_count<MapFileOptions>() - 2 + member_count<MapDrawingOptions>() + member_count<GeoReference>();
  // Front end, consensus, matches, smoothing and seed of the localizer are the mapper's.
  const std::size_t localization = member_count<LocalizerOptions>() - 4 +
                                   member_count<GlobalSearchOptions>() - 4 +
                                   member_count<ScanContextOptions>();
  const std::size_t others =
      member_count<GridMapOptions>() + files + member_count<RunOptions>() + localization;
  EXPECT_EQ(described(), log + mapper + others)
      << "a struct of options has a member that describe() of settings.cpp does not know";
}

TEST_F(SettingsTest, every_option_is_bound_to_a_member_of_its_own) {
  const auto others_as_by_default = [&](const Option& changed) {
    for (const OptionSection& section : table_.sections())
      for (const Option& option : section.options)
        if (&option != &changed && option.text() != option.default_text) return false;
    return true;
  };
  std::size_t changed = 0;
  for (const OptionSection& section : table_.sections()) {
    for (const Option& option : section.options) {
      std::vector<std::string> texts{"1", "2", "0.3", "0.7", "0.9", "9", "20000", "false", "true"};
      texts.insert(texts.end(), option.choices.begin(), option.choices.end());
      for (const std::string& text : texts)
        if (option.text() == option.default_text) option.assign(text);
      changed += option.text() != option.default_text ? 1 : 0;
      EXPECT_TRUE(others_as_by_default(option)) << option.name();
      ASSERT_TRUE(option.assign(option.default_text));
    }
  }
  EXPECT_EQ(changed, described());
}

TEST_F(SettingsTest, a_dump_of_changed_settings_restores_them) {
  for (const char* change : {"log.max_range_m=50.5", "log.laser_yaw_deg=-90", "log.beam_angles=skip_zero",
                             "log.laser=rear", "front_end.window_theta_deg=7.1", "run.seed=7",
                             "pose_graph.loop_kernel=dynamic_scaling", "map.resolution_m=0.025"})
    apply_override(change, table_);
  Settings other;
  OptionTable other_table;
  describe(other_table, other);
  apply(parse_ini(dump(table_), "dump.ini"), other_table);
  EXPECT_EQ(dump(other_table), dump(table_));
  EXPECT_EQ(other.log.max_range_m, 50.5);
  EXPECT_EQ(other.log.beam_angles, BeamAngles::kSkipZero);
  EXPECT_EQ(other.mapper.front_end.window_rad, settings_.mapper.front_end.window_rad);
}

TEST_F(SettingsTest, the_defaults_agree_with_each_other) {
  EXPECT_NO_THROW(check(Settings{}));
}

TEST_F(SettingsTest, refuses_options_that_contradict_each_other) {
  EXPECT_EQ(refusal({"log.min_range_m=5", "log.max_range_m=4"}),
            "log.min_range_m = 5 must be less than log.max_range_m = 4");
  EXPECT_EQ(refusal({"log.max_range_m=auto", "log.min_range_m=60"}),
            "log.min_range_m = 60 must be less than front_end.max_range_m = 40");
  EXPECT_EQ(refusal({"log.min_range_m=0", "front_end.min_range_m=50"}),
            "front_end.min_range_m = 50 must be less than front_end.max_range_m = 40");
  EXPECT_EQ(refusal({"front_end.min_range_m=0", "front_end.window_theta_deg=50"}).substr(0, 66),
            "front_end.window_theta_deg = 50 must not be more than front_end.ma");
  EXPECT_THAT(refusal({"front_end.window_theta_deg=5", "loop_closure.window_x_m=0.1"}),
              HasSubstr("must not be more than loop_closure.window_x_m = 0.1"));
  EXPECT_EQ(refusal({"loop_closure.window_x_m=8", "last_pass.window_m=1.5"}),
            "last_pass.window_m = 1.5 must not be more than verification.wide_window_m = 1");
  EXPECT_THAT(refusal({"last_pass.window_m=0.3", "loop_closure.window_x_m=4", "loop_closure.min_sigma_m=9"}),
              HasSubstr("loop_closure.min_sigma_m = 9 must not be more than loop_closure.max_sigma_m"));
}

TEST_F(SettingsTest, refuses_thresholds_of_psi_that_leave_nothing_between_them) {
  EXPECT_EQ(refusal({"psi.psi_1=5", "psi.psi_2=4"}), "psi.psi_1 = 5 must be less than psi.psi_2 = 4");
  EXPECT_EQ(refusal({"psi.psi_1=4"}), "psi.psi_1 = 4 must be less than psi.psi_2 = 4");
  EXPECT_EQ(refusal({"psi.psi_1=3.9"}), "");
}

TEST_F(SettingsTest, refuses_a_coordinate_system_that_a_map_cannot_lie_in) {
  EXPECT_EQ(refusal({"map.epsg=25832"}), "");
  EXPECT_THAT(refusal({"map.epsg=4326"}), HasSubstr("expected a projected system in metres"));
  EXPECT_EQ(refusal({"map.epsg=99999"}),
            "map.epsg = 99999: no such coordinate system. Give the EPSG number of a projected system in metres");
}

TEST_F(SettingsTest, seed_and_threads_of_the_run_reach_the_mapper) {
  apply_override("run.seed=7", table_);
  apply_override("run.threads=3", table_);
  EXPECT_EQ(mapper_options(settings_).seed, 7U);
  EXPECT_EQ(mapper_options(settings_).threads, 3);
  apply_override("run.threads=0", table_);
  EXPECT_EQ(mapper_options(settings_).threads, worker_threads({1, 0}));
}

TEST_F(SettingsTest, a_mount_stated_in_part_is_zero_elsewhere_and_the_logs_own_if_not_stated) {
  EXPECT_FALSE(log_options(settings_).robot_T_laser.has_value());
  apply_override("log.laser_yaw_deg=180", table_);
  const auto mount = log_options(settings_).robot_T_laser;
  ASSERT_TRUE(mount.has_value());
  EXPECT_EQ(*mount, mrpt::math::TPose2D(0, 0, M_PI));
}

TEST_F(SettingsTest, zero_threads_are_those_of_the_machine) {
  EXPECT_GE(worker_threads({}), 1);
  EXPECT_EQ(worker_threads({1, 3}), 3);
}

}  // namespace
}  // namespace psi_slam
