// SPDX-License-Identifier: BSD-3-Clause
// Tests the shipped settings files and the texts that the program prints about settings.
#include <gmock/gmock.h>

#include <filesystem>

#include "app_run.h"
#include "base/config/ini_file.h"
#include "base/config/settings_text.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

const fs::path kFolder = PSI_SLAM_INI_FOLDER;

struct Loaded {
  Settings settings;
  OptionTable table;
  Loaded() { describe(table, settings); }
};

TEST(ShippedSettings, a_dump_has_every_key_and_gives_the_defaults) {
  Loaded loaded;
  const std::string defaults = dump(loaded.table);
  const IniFile file = parse_ini(run_app({"--dump-config"}).out, "psi-slam.ini");
  apply(file, loaded.table);
  EXPECT_TRUE(dump(loaded.table) == defaults);
  std::size_t options = 0;
  for (const OptionSection& section : loaded.table.sections()) options += section.options.size();
  EXPECT_EQ(file.values.size(), options);
}

TEST(ShippedSettings, every_file_loads_and_states_facts_of_robot_and_sensor_only) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().filename() == "graphslam.ini")
      continue;  // settings of psi-graphslam, tested in tests/mrpt
    SCOPED_TRACE(entry.path().string());
    Loaded loaded;
    EXPECT_NO_THROW(apply(read_ini(entry.path()), loaded.table));
    EXPECT_NO_THROW(check(loaded.settings));
    for (const OptionSection& section : loaded.table.sections())
      for (const Option& option : section.options)
        EXPECT_TRUE(section.name == "log" || option.text() == option.default_text) << option.name();
    ++files;
  }
  EXPECT_GE(files, 5U);
}

TEST(ShippedSettings, a_dump_is_a_file_that_loads) {
  const TemporaryFolder folder;
  const fs::path ini = folder.path() / "dumped.ini";
  const AppRun dumped = run_app({"--dump-config", "-c", (kFolder / "aces.ini").string(), "--set",
                                 "front_end.node_rotation_deg=25", "--seed", "9"});
  EXPECT_EQ(dumped.code, 0);
  EXPECT_EQ(dumped.err, "");
  write_bytes(ini, dumped.out);
  EXPECT_TRUE(run_app({"--dump-config", "-c", ini.string()}).out == dumped.out);
  EXPECT_THAT(dumped.out, HasSubstr("\nnode_rotation_deg = 25\n"));
  EXPECT_THAT(dumped.out, HasSubstr("\nseed = 9\n"));
  EXPECT_THAT(dumped.out, HasSubstr("\nbeam_angles = centred_half_step\n"));
}

TEST(ShippedSettings, every_option_is_explained) {
  Loaded loaded;
  const AppRun terminal = run_app({"options"});
  const AppRun markdown = run_app({"options", "--markdown"});
  EXPECT_EQ(terminal.code + markdown.code, 0);
  for (const OptionSection& section : loaded.table.sections()) {
    EXPECT_THAT(markdown.out, HasSubstr("## `[" + section.name + "]`"));
    for (const Option& option : section.options) {
      EXPECT_THAT(terminal.out, HasSubstr("  " + option.name() + "\n"));
      EXPECT_THAT(markdown.out, HasSubstr("| `" + option.key + "` |"));
      EXPECT_FALSE(option.help.empty()) << option.name();
      EXPECT_THAT(option.help, testing::EndsWith(".")) << option.name();
    }
  }
}

}  // namespace
}  // namespace psi_slam
