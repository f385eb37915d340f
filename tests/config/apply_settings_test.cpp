// SPDX-License-Identifier: BSD-3-Clause
#include "config/apply_settings.h"

#include <gtest/gtest.h>

#include "sample_settings.h"

namespace psi_slam {
namespace {

class ApplySettingsTest : public testing::Test {
 protected:
  void apply_text(const std::string& text) { apply(parse_ini(text, "my.ini"), table_); }
  std::string refusal(const std::string& text) {
    return sentence([&] { apply_text(text); });
  }
  std::string override_refusal(const std::string& assignment) {
    return sentence([&] { apply_override(assignment, table_); });
  }

  SampleSettings settings_;
  OptionTable table_ = describe(settings_);
};

TEST_F(ApplySettingsTest, loads_a_file) {
  apply_text(
      "[front_end]\nwindow_x_m = 1\nmatcher = ga ; genetic\n[log]\nlabel = \"a;b\"\nmax_range_m = 30\n");
  EXPECT_EQ(settings_.window_x_m, 1);
  EXPECT_EQ(settings_.matcher, SampleMatcher::kGa);
  EXPECT_EQ(settings_.label, "a;b");
  EXPECT_EQ(settings_.max_range_m, 30);
  EXPECT_EQ(settings_.passes, 2) << "what the file does not name keeps its value";
}

TEST_F(ApplySettingsTest, names_file_and_line_of_a_mistake) {
  EXPECT_EQ(refusal("[front_end]\nwindow_x_m = abc\n"),
            "my.ini:2: front_end.window_x_m = abc: expected a number of metres between 0.01 and 20");
  EXPECT_EQ(refusal("[front_end]\n\nwindw_x_m = 1\n"),
            R"(my.ini:3: unknown key "windw_x_m" in [front_end]; did you mean "window_x_m"?)");
  EXPECT_EQ(refusal("[front_end]\npsi_1 = 1\n"),
            R"(my.ini:2: unknown key "psi_1" in [front_end]; "psi_1" belongs in [psi])");
  EXPECT_EQ(refusal("[front_end]\n[fornt_end]\n"),
            "my.ini:2: unknown section [fornt_end]; did you mean [front_end]?");
}

TEST_F(ApplySettingsTest, a_file_with_a_mistake_changes_nothing) {
  EXPECT_NE(refusal("[front_end]\nwindow_x_m = 1\npasses = 1\n[log]\nlabel = x\nseed = x\n"), "");
  EXPECT_EQ(settings_.window_x_m, SampleSettings().window_x_m);
  EXPECT_EQ(settings_.passes, SampleSettings().passes);
  EXPECT_EQ(settings_.label, SampleSettings().label);
}

TEST_F(ApplySettingsTest, the_command_line_overrides) {
  apply_override("front_end.window_x_m=2", table_);
  apply_override(" front_end.passes = 3 ", table_);
  apply_override("log.label=a=b.c", table_);
  EXPECT_EQ(settings_.window_x_m, 2);
  EXPECT_EQ(settings_.passes, 3);
  EXPECT_EQ(settings_.label, "a=b.c");
}

TEST_F(ApplySettingsTest, a_mistake_on_the_command_line_names_its_option) {
  EXPECT_EQ(override_refusal("front_end.window_x_m=far"),
            "--set: front_end.window_x_m = far: expected a number of metres between 0.01 and 20");
  EXPECT_EQ(override_refusal("front_end.windw_x_m=1"),
            R"(--set: unknown key "windw_x_m" in [front_end]; did you mean "window_x_m"?)");
  for (const std::string assignment : {"front_end.window_x_m", "window_x_m=1", "=1", ""})
    EXPECT_EQ(override_refusal(assignment), "--set: expected section.key=value, not \"" + assignment + '"');
}

}  // namespace
}  // namespace psi_slam
