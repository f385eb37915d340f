// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

#include <gmock/gmock.h>

#include <cctype>
#include <functional>
#include <set>

#include "base/config/ini_file.h"
#include "base/config/settings_text.h"
#include "member_count.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class SettingsTest : public testing::Test {
 protected:
  SettingsTest() { describe(table_, settings_); }

  /// Returns the error message for these settings; "" if they are accepted.
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
  // LaserMount describes the pose of the laser, which is one member of LogOptions.
  const std::size_t log = member_count<LogOptions>() - 1 + member_count<LaserMount>();
  // Of a refinement, only the score's deviation and the last step are named, of the final refinement the
  // rounds, of the solver the iterations. Three numbers of the consensus are not named.
  constexpr std::size_t kOfRefinement = 2;
  constexpr std::size_t kOfJointRefinement = 1;
  constexpr std::size_t kOfSolver = 1;
  // Of the front end, six numbers of odometry's noise, five of the prior and one share are not named.
  constexpr std::size_t kNoOptionsOfFrontEnd = 12;
  const std::size_t front_end = member_count<FrontEndOptions>() - 5 - kNoOptionsOfFrontEnd +
                                member_count<ScanFilterOptions>() + member_count<LocalMapOptions>() +
                                kOfRefinement + member_count<ConstantVelocityOptions>() +
                                member_count<DoubtfulCorrectionOptions>();
  const std::size_t matcher = member_count<MatcherOptions>() - 1 + kOfRefinement;
  const std::size_t loops = member_count<LoopClosureOptions>() - 3 + member_count<LoopCandidateOptions>() -
                            1 + member_count<SearchExtent>() + member_count<LoopVerificationOptions>() +
                            member_count<ScanContextOptions>() + member_count<LoopConsensusOptions>() - 3 +
                            member_count<FinalSearchOptions>() + kOfJointRefinement;
  const std::size_t choice = member_count<PsiOptions>() + member_count<GeneticOptions>() - 2 +
                             member_count<PaperGeneticOptions>() + member_count<MemeticGeneticOptions>();
  // MapperOptions has three structs and the noise of the path as members, and takes two flags of the back end
  // from elsewhere. BackEndOptions has seven structs, and takes seed, threads and their priority from
  // elsewhere.
  const std::size_t mapper = member_count<MapperOptions>() - 6 + member_count<BackEndOptions>() - 10 +
                             choice + front_end + matcher + loops + kOfSolver;
  const std::size_t files =
      member_count<MapFileOptions>() - 2 + member_count<MapDrawingOptions>() + member_count<GeoReference>();
  // The localizer takes front end, consensus, matches, smoothing and seed from the mapper.
  const std::size_t localization = member_count<LocalizerOptions>() - 4 +
                                   member_count<GlobalSearchOptions>() - 4 +
                                   member_count<ScanContextOptions>();
  const std::size_t others = member_count<GridMapOptions>() + member_count<MapFrameOptions>() +
                             member_count<PriorOptions>() + files + member_count<LiveOptions>() +
                             member_count<RunOptions>() + localization;
  EXPECT_EQ(table_.options_and_constants().size(), log + mapper + others)
      << "a struct of options has a member that describe() of settings.cpp does not know";
}

TEST_F(SettingsTest, each_option_and_constant_is_bound_to_one_member) {
  const std::vector<const Option*> all = table_.options_and_constants();
  std::size_t changed = 0;
  for (const Option* option : all) {
    std::vector<std::string> texts{"1", "2", "0.3", "0.7", "0.9", "9", "20000", "false", "true"};
    texts.insert(texts.end(), option->choices.begin(), option->choices.end());
    for (const std::string& text : texts)
      if (option->text() == option->default_text) option->assign(text);
    changed += option->text() != option->default_text ? 1 : 0;
    for (const Option* other : all)
      EXPECT_TRUE(other == option || other->text() == other->default_text)
          << option->name() << ", " << other->name();
    ASSERT_TRUE(option->assign(option->default_text));
  }
  EXPECT_EQ(changed, all.size());
}

TEST_F(SettingsTest, a_dump_of_changed_settings_restores_them) {
  for (const char* change :
       {"log.max_range_m=50.5", "log.laser_yaw_deg=-90", "log.beam_angles=skip_zero", "log.laser=rear",
        "front_end.node_rotation_deg=7.1", "run.seed=7", "psi.psi_2=3", "map.resolution_m=0.025"})
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

TEST_F(SettingsTest, rejects_options_that_contradict_each_other) {
  EXPECT_EQ(refusal({"log.min_range_m=5", "log.max_range_m=4"}),
            "log.min_range_m = 5 must be less than log.max_range_m = 4");
}

TEST_F(SettingsTest, rejects_values_whose_squares_overflow) {
  EXPECT_THROW(apply_override("map.print_scale=1e-300", table_), UserError);
}

TEST_F(SettingsTest, old_option_names_are_accepted_with_a_warning) {
  apply(parse_ini("[log]\nodometry_topic = /odom\n[last_pass]\npasses = 1\n", "my.ini"), table_);
  EXPECT_THAT(dump(table_), HasSubstr("\nodometry = /odom\n"));
  EXPECT_THAT(table_.take_warnings(),
              testing::ElementsAre("my.ini:2: option log.odometry_topic was renamed; write log.odometry",
                                   "my.ini:4: section [last_pass] was renamed; write [final_search]"));
}

TEST_F(SettingsTest, options_of_the_first_version_are_accepted) {
  apply(parse_ini("[front_end]\nmin_response = 0.3\nodometry_sigma_theta_per_turn = 0.02\n", "my.ini"),
        table_);
  EXPECT_THAT(
      table_.take_warnings(),
      testing::ElementsAre("my.ini:2: front_end.min_response, front_end.odometry_sigma_theta_per_turn have "
                           "no effect any more; remove them"));
}

TEST_F(SettingsTest, files_cannot_change_constants_of_the_method) {
  apply(parse_ini("[consensus]\nmemory_m = 9\n[front_end]\nwindow_m = 0.15\nmin_range_m = 2\n", "my.ini"),
        table_);
  EXPECT_EQ(settings_.mapper.back_end.loop_consensus.memory_m, LoopConsensusOptions().memory_m);
  EXPECT_THAT(
      table_.take_warnings(),
      testing::ElementsAre("my.ini:2: consensus.memory_m (always 4), front_end.min_range_m have no effect "
                           "any more; remove them"));
  apply_override("consensus.memory_m=9", table_, true);
  EXPECT_EQ(settings_.mapper.back_end.loop_consensus.memory_m, 9);
  EXPECT_THAT(
      dump(table_),
      HasSubstr("[consensus]\n\n; A constant of the method. Only programs change it.\nmemory_m = 9\n"));
  EXPECT_THROW(apply_override("consensus.memory_m=-1", table_, true), UserError);
}

TEST_F(SettingsTest, every_help_text_stands_alone) {
  for (const OptionSection& section : table_.sections()) {
    for (const Option& option : section.options) {
      EXPECT_EQ(option.help.back(), '.') << option.name();
      EXPECT_TRUE(std::isupper(static_cast<unsigned char>(option.help.front())) != 0 ||
                  option.name() == "genetic.variant")
          << option.name();
      for (const char* reference : {"the same", "up to here", "this much)", "of those", " it,"})
        EXPECT_EQ(option.help.find(reference), std::string::npos) << option.name() << ": " << option.help;
    }
  }
}

TEST_F(SettingsTest, rejects_thresholds_of_psi_in_the_wrong_order) {
  EXPECT_EQ(refusal({"psi.psi_1=5", "psi.psi_2=4"}), "psi.psi_1 = 5 must not be more than psi.psi_2 = 4");
  EXPECT_EQ(refusal({"psi.psi_1=4", "psi.psi_2=4"}), "");
}

TEST_F(SettingsTest, rejects_a_coordinate_system_that_is_not_in_metres) {
  EXPECT_EQ(refusal({"map.epsg=25832"}), "");
  EXPECT_THAT(refusal({"map.epsg=4326"}), HasSubstr("expected a projected coordinate system in metres"));
  EXPECT_EQ(
      refusal({"map.epsg=99999"}),
      "map.epsg = 99999: no such coordinate system. Give the EPSG number of a projected system in metres");
}

TEST_F(SettingsTest, seed_and_threads_of_the_run_reach_the_mapper) {
  apply_override("run.seed=7", table_);
  apply_override("run.threads=3", table_);
  EXPECT_EQ(mapper_options(settings_).back_end.seed, 7U);
  EXPECT_EQ(mapper_options(settings_).back_end.threads, 3);
  apply_override("run.threads=0", table_);
  EXPECT_EQ(mapper_options(settings_).back_end.threads, worker_threads({1, 0}));
}

TEST_F(SettingsTest, a_partly_stated_mount_is_zero_in_its_other_parts) {
  EXPECT_FALSE(log_options(settings_).robot_T_laser.has_value());
  apply_override("log.laser_yaw_deg=180", table_);
  const auto mount = log_options(settings_).robot_T_laser;
  ASSERT_TRUE(mount.has_value());
  EXPECT_EQ(*mount, mrpt::math::TPose2D(0, 0, M_PI));
}

TEST_F(SettingsTest, zero_threads_means_one_for_each_processor) {
  EXPECT_GE(worker_threads({}), 1);
  EXPECT_EQ(worker_threads({1, 3}), 3);
}

}  // namespace
}  // namespace psi_slam
