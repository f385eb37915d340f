// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/configuration.h"

#include <gmock/gmock.h>

#include <fstream>
#include <functional>

#include "psi_slam/user_error.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Configuration, begins_with_the_defaults) {
  const Configuration configuration;
  EXPECT_EQ(configuration.value("map.resolution_m"), "0.05");
  EXPECT_EQ(static_cast<const GridMapOptions&>(configuration).resolution_m, GridMapOptions().resolution_m);
  EXPECT_THAT(configuration.warnings(), IsEmpty());
}

TEST(Configuration, passes_values_to_the_part_that_uses_them) {
  Configuration configuration;
  configuration.set("run.seed", "7");
  configuration.set("log.laser_x_m", "0.2");
  configuration.set("front_end.window_m", "0.5");
  EXPECT_EQ(static_cast<const MapperOptions&>(configuration).front_end.window_m, 0.5);
  EXPECT_EQ(configuration.mapper_options()->front_end.window_m, 0.5);
  EXPECT_EQ(static_cast<const LocalizerOptions&>(configuration).front_end.window_m, 0.5);
  EXPECT_EQ(static_cast<const LocalizerOptions&>(configuration).seed, 7U);
  EXPECT_EQ(static_cast<const LogOptions&>(configuration).robot_T_laser->x, 0.2);
}

TEST(Configuration, is_restored_from_its_text) {
  const TemporaryFolder folder;
  Configuration configuration;
  configuration.set("front_end.node_rotation_deg", "12.5");
  std::ofstream(folder.path() / "my.ini") << configuration.text();
  Configuration restored;
  restored.load(folder.path() / "my.ini");
  EXPECT_EQ(restored.text(), configuration.text());
}

TEST(Configuration, copies_are_independent) {
  Configuration configuration;
  configuration.set("run.seed", "7");
  Configuration copy = configuration;
  copy.set("run.seed", "8");
  EXPECT_EQ(configuration.value("run.seed"), "7");
  EXPECT_EQ(copy.value("run.seed"), "8");
}

TEST(Configuration, warns_about_old_names) {
  Configuration configuration;
  configuration.set("log.odometry_topic", "/odom");
  EXPECT_EQ(configuration.value("log.odometry"), "/odom");
  ASSERT_EQ(configuration.warnings().size(), 1U);
  EXPECT_THAT(configuration.warnings().front(), HasSubstr("write log.odometry"));
}

TEST(Configuration, names_the_mistake) {
  Configuration configuration;
  EXPECT_THAT(message_of([&] { configuration.set("map.resolution", "1"); }), HasSubstr("did you mean"));
  EXPECT_THAT(message_of([&] { configuration.set("map.resolution_m", "wide"); }), HasSubstr("wide"));
  EXPECT_THAT(message_of([&] { configuration.value("map.colour"); }),
              HasSubstr("unknown key \"colour\" in [map]"));
  EXPECT_THAT(message_of([&] { configuration.set("front_end.window_m", "wide"); }), HasSubstr("wide"));
  configuration.set("psi.psi_1", "3");
  configuration.set("psi.psi_2", "2");
  EXPECT_THAT(message_of([&] { configuration.check(); }), HasSubstr("psi.psi_2"));
  EXPECT_THROW(static_cast<void>(static_cast<const MapperOptions&>(configuration)), UserError);
}

}  // namespace
}  // namespace psi_slam
