// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graphslam_settings.h"

#include <gmock/gmock.h>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

Settings read(const std::string& text) {
  const TemporaryFolder folder;
  write_file(folder.path() / "my.ini", text);
  return read_graphslam_settings(folder.path() / "my.ini");
}

TEST(GraphSlamSettings, reads_keys_with_a_dot_and_ignores_others) {
  const Settings settings = read(
      "[GeneralConfiguration]\nsave_graph = true\n"
      "[NodeRegistrationDeciderParameters]\nregistration_max_distance = 0.3 // meters\n"
      "front_end.node_distance_m = 0.4\n"
      "[EdgeRegistrationDeciderParameters]\nloop_closure.matcher = csm\nrun.seed = 7\n"
      "[OptimizerParameters]\npose_graph.max_iterations = 9\n");
  EXPECT_EQ(settings.mapper.front_end.node_distance_m, 0.4);
  EXPECT_EQ(settings.mapper.back_end.matcher, MatcherKind::kCsm);
  EXPECT_EQ(settings.run.seed, 7U);
  EXPECT_EQ(settings.mapper.pose_graph.max_iterations, 9);
}

TEST(GraphSlamSettings, obsolete_options_are_accepted_in_any_section) {
  const Settings settings =
      read("[EdgeRegistrationDeciderParameters]\npose_graph.max_loop_chi = 5\nrun.seed = 7\n");
  EXPECT_EQ(settings.run.seed, 7U);
}

TEST(GraphSlamSettings, errors_name_file_and_line) {
  const std::string node = "[NodeRegistrationDeciderParameters]\n";
  EXPECT_THAT(sentence_of([&] { read(node + "front_end.node_distanc_m = 1\n"); }),
              AllOf(HasSubstr("my.ini:2"), HasSubstr("node_distance_m")));
  EXPECT_THAT(sentence_of([&] { read(node + "front_end.node_distance_m = far\n"); }), HasSubstr("my.ini:2"));
  EXPECT_THAT(sentence_of([&] { read(node + "loop_closure.matcher = ga\n"); }),
              HasSubstr("belongs in section [EdgeRegistrationDeciderParameters]"));
  EXPECT_THAT(sentence_of([&] { read(node + "map.resolution_m = 0.1\n"); }), HasSubstr("has no effect"));
  EXPECT_THAT(sentence_of([&] { read(node + "log.min_range_m = 5\nlog.max_range_m = 4\n"); }),
              HasSubstr("must be less than"));
}

TEST(GraphSlamSettings, lists_every_option_in_at_most_one_section_as_readable_settings) {
  const BoundSettings bound;
  std::string all;
  std::size_t listed = 0;
  for (const char* section : {kNodeDeciderSection, kEdgeDeciderSection, kOptimizerSection})
    all += '[' + std::string(section) + "]\n" + graphslam_options_text(bound.table, section);
  for (const OptionSection& section : bound.table.sections())
    for (const Option& option : section.options) {
      const bool has_effect = !graphslam_section_of(option.name()).empty();
      const std::size_t first = all.find('\n' + option.name() + " = ");
      EXPECT_EQ(first != std::string::npos, has_effect) << option.name();
      listed += has_effect ? 1 : 0;
      if (has_effect) {
        EXPECT_EQ(all.find('\n' + option.name() + " = ", first + 1), std::string::npos);
      }
    }
  EXPECT_GT(listed, 30U);
  read(all);
}

TEST(GraphSlamSettings, the_shipped_file_can_be_read) {
  const Settings settings = read_graphslam_settings(PSI_SLAM_INI_FOLDER "/graphslam.ini");
  EXPECT_EQ(settings.mapper.front_end.node_distance_m, FrontEndOptions().node_distance_m);
}

}  // namespace
}  // namespace psi_slam
