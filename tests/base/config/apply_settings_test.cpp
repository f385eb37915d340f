// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/settings_text.h"

#include <gmock/gmock.h>

#include "sample_settings.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

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
  EXPECT_EQ(settings_.passes, 2) << "options that the file does not set keep their values";
}

TEST_F(ApplySettingsTest, names_file_and_line_of_a_mistake) {
  EXPECT_EQ(refusal("[front_end]\nwindow_x_m = abc\n"),
            "my.ini:2: front_end.window_x_m = abc: expected a number of metres between 0.01 and 20");
  EXPECT_EQ(refusal("[front_end]\n\nwindw_x_m = 1\n"),
            R"(my.ini:3: unknown key "windw_x_m" in [front_end]; did you mean "window_x_m"?)");
  EXPECT_EQ(refusal("[front_end]\npsi_1 = 1\n"),
            R"(my.ini:2: unknown key "psi_1" in [front_end]; "psi_1" belongs in [psi])");
  EXPECT_EQ(refusal(std::string("[front_end]\nwindow_x_m = 1\0 m\n", 30)),
            "my.ini:2: front_end.window_x_m = 1? m: expected a number of metres between 0.01 and 20");
  EXPECT_EQ(refusal("[front_end]\n" + std::string(100'000, 'w') + " = 1\n"),
            "my.ini:2: unknown key \"" + std::string(80, 'w') + "...\" in [front_end]");
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

class OldNamesTest : public ApplySettingsTest {
 protected:
  OldNamesTest() {
    table_.alias("scan_matching", "front_end")
        .alias("front_end.rounds", "front_end.passes")
        .alias("scan_matching.first_psi", "psi.psi_1");
  }
};

TEST_F(OldNamesTest, an_old_key_is_accepted_with_a_warning_that_names_the_new_one) {
  apply_text("[front_end]\nwindow_x_m = 1\nrounds = 3\n");
  EXPECT_EQ(settings_.passes, 3);
  EXPECT_THAT(table_.take_warnings(),
              ElementsAre("my.ini:3: option front_end.rounds was renamed; write front_end.passes"));
  EXPECT_THAT(table_.take_warnings(), IsEmpty());
}

TEST_F(OldNamesTest, an_old_section_is_accepted_with_one_warning_for_its_unchanged_keys) {
  apply_text("[scan_matching]\nwindow_x_m = 1\nrounds = 3\nfirst_psi = 5\nnodes = 4\n");
  EXPECT_EQ(settings_.window_x_m, 1);
  EXPECT_EQ(settings_.passes, 3);
  EXPECT_EQ(settings_.psi_1, 5);
  EXPECT_EQ(settings_.nodes, 4U);
  EXPECT_THAT(table_.take_warnings(),
              ElementsAre("my.ini:2: section [scan_matching] was renamed; write [front_end]",
                          "my.ini:3: option scan_matching.rounds was renamed; write front_end.passes",
                          "my.ini:4: option scan_matching.first_psi was renamed; write psi.psi_1"));
}

TEST_F(OldNamesTest, the_command_line_takes_old_names) {
  apply_override("scan_matching.nodes=4", table_);
  apply_override("front_end.rounds=1", table_);
  EXPECT_EQ(settings_.nodes, 4U);
  EXPECT_EQ(settings_.passes, 1);
  EXPECT_THAT(table_.take_warnings(),
              ElementsAre("--set: section [scan_matching] was renamed; write [front_end]",
                          "--set: option front_end.rounds was renamed; write front_end.passes"));
}

TEST_F(OldNamesTest, new_names_give_no_warning) {
  apply_text("[front_end]\npasses = 3\n");
  EXPECT_THAT(table_.take_warnings(), IsEmpty());
}

TEST_F(OldNamesTest, refusals_use_the_new_name_and_leave_no_warning) {
  EXPECT_EQ(refusal("[scan_matching]\nrounds = 3\nrounds_ = 3\n"),
            R"(my.ini:3: unknown key "rounds_" in [front_end])");
  EXPECT_EQ(override_refusal("scan_matching.rounds=9"),
            "--set: front_end.passes = 9: expected a whole number between -5 and 5");
  EXPECT_EQ(settings_.passes, 2);
  EXPECT_THAT(table_.take_warnings(), IsEmpty());
}

TEST_F(OldNamesTest, one_file_cannot_give_an_option_by_both_names) {
  EXPECT_EQ(
      refusal("[front_end]\nrounds = 3\npasses = 4\n"),
      "my.ini:3: front_end.passes and front_end.rounds (my.ini:2) are the same option; keep one, called "
      "front_end.passes");
  EXPECT_EQ(settings_.passes, 2);
}

TEST_F(OldNamesTest, a_file_overrides_the_old_name_of_an_included_one) {
  IniFile file = parse_ini("[front_end]\nrounds = 3\n", "usual.ini");
  file.values.push_back({"front_end", "passes", "4", "my.ini:3"});
  apply(file, table_);
  EXPECT_EQ(settings_.passes, 4);
}

}  // namespace
}  // namespace psi_slam
