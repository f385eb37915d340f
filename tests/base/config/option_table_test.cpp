// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/option_table.h"

#include <gmock/gmock.h>

#include <cmath>
#include <stdexcept>

#include "sample_settings.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class OptionTableTest : public testing::Test {
 protected:
  std::string refusal(const std::string& name, const std::string& text) {
    return sentence([&] { table_.set(name, text, "my.ini:12"); });
  }

  SampleSettings settings_;
  OptionTable table_ = describe(settings_);
};

TEST_F(OptionTableTest, sets_the_members_it_is_bound_to) {
  table_.set("front_end.window_x_m", "2.5", "test");
  table_.set("front_end.window_theta_deg", "180", "test");
  table_.set("front_end.matcher", "ga", "test");
  table_.set("front_end.passes", "-3", "test");
  table_.set("log.seed", "18446744073709551615", "test");
  table_.set("log.max_range_m", "81.9", "test");
  table_.set("log.field_of_view_deg", "auto", "test");
  table_.set("log.label", "", "test");
  EXPECT_EQ(settings_.window_x_m, 2.5);
  EXPECT_EQ(settings_.window_theta_rad, M_PI);
  EXPECT_EQ(settings_.matcher, SampleMatcher::kGa);
  EXPECT_EQ(settings_.passes, -3);
  EXPECT_EQ(settings_.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(settings_.max_range_m, 81.9);
  EXPECT_EQ(settings_.field_of_view_rad, std::nullopt);
  EXPECT_EQ(settings_.label, "");
}

TEST_F(OptionTableTest, shows_the_current_values_of_the_members) {
  settings_.window_x_m = 1;
  EXPECT_EQ(table_.option("front_end.window_x_m", "test").text(), "1");
  EXPECT_EQ(table_.option("front_end.window_x_m", "test").default_text, "0.15");
  EXPECT_EQ(table_.option("log.max_range_m", "test").text(), "auto");
  settings_.max_range_m = 30;
  EXPECT_EQ(table_.option("log.max_range_m", "test").text(), "30");
}

TEST_F(OptionTableTest, accepts_the_spellings_of_true_and_false) {
  for (const char* text : {"true", "yes", "on", "1", "True", "YES"}) {
    settings_.close_loops = false;
    table_.set("front_end.close_loops", text, "test");
    EXPECT_TRUE(settings_.close_loops) << text;
  }
  for (const char* text : {"false", "no", "off", "0", "False", "OFF"}) {
    settings_.close_loops = true;
    table_.set("front_end.close_loops", text, "test");
    EXPECT_FALSE(settings_.close_loops) << text;
  }
  for (const char* text : {"", "2", "y", "truee", "auto"})
    EXPECT_EQ(refusal("front_end.close_loops", text),
              std::string("my.ini:12: front_end.close_loops = ") + text + ": expected true or false");
}

TEST_F(OptionTableTest, rejects_texts_that_are_not_numbers_of_the_range) {
  for (const char* text :
       {"abc", "12abc", "nan", "inf", "-inf", "1e999", "", "0.009", "20.0001", "-1", "auto"})
    EXPECT_EQ(refusal("front_end.window_x_m", text), std::string("my.ini:12: front_end.window_x_m = ") +
                                                         text +
                                                         ": expected a number of metres between 0.01 and 20");
  EXPECT_EQ(settings_.window_x_m, 0.15);
}

TEST_F(OptionTableTest, the_range_of_an_angle_is_in_degrees) {
  EXPECT_EQ(
      refusal("front_end.window_theta_deg", "0"),
      "my.ini:12: front_end.window_theta_deg = 0: expected a number of degrees above 0 and at most 180");
  EXPECT_THAT(refusal("front_end.window_theta_deg", "180.5"), HasSubstr("expected a number of degrees"));
  EXPECT_EQ(settings_.window_theta_rad, 0.07);
}

TEST_F(OptionTableTest, rejects_texts_that_are_not_integers_of_the_range) {
  for (const char* text : {"1.5", "1e3", "6", "-6", "2 ", "0x1", "99999999999999999999", "nan"})
    EXPECT_EQ(refusal("front_end.passes", text), std::string("my.ini:12: front_end.passes = ") + text +
                                                     ": expected a whole number between -5 and 5");
  EXPECT_EQ(refusal("front_end.nodes", "0"),
            "my.ini:12: front_end.nodes = 0: expected a whole number of nodes, 1 or more");
  EXPECT_EQ(refusal("log.seed", "-1"), "my.ini:12: log.seed = -1: expected a whole number, 0 or more");
  EXPECT_EQ(settings_.passes, 2);
}

TEST_F(OptionTableTest, rejects_other_choices_and_texts_of_two_lines) {
  EXPECT_EQ(refusal("front_end.matcher", "CSM"),
            "my.ini:12: front_end.matcher = CSM: expected one of csm, ga");
  EXPECT_EQ(refusal("log.max_range_m", "far"),
            "my.ini:12: log.max_range_m = far: expected auto or a number of metres above 0");
  EXPECT_THAT(refusal("log.label", "two\nlines"), HasSubstr("expected a text of one line"));
}

TEST_F(OptionTableTest, proposes_the_nearest_name) {
  EXPECT_EQ(refusal("front_end.windw_x_m", "1"),
            R"(my.ini:12: unknown key "windw_x_m" in [front_end]; did you mean "window_x_m"?)");
  EXPECT_EQ(refusal("front_end.psi_1", "1"),
            R"(my.ini:12: unknown key "psi_1" in [front_end]; "psi_1" belongs in [psi])");
  EXPECT_EQ(refusal("front_end.max_rnge_m", "1"),
            R"(my.ini:12: unknown key "max_rnge_m" in [front_end]; did you mean "max_range_m" in [log]?)");
  EXPECT_EQ(refusal("front_end.resolution", "1"), R"(my.ini:12: unknown key "resolution" in [front_end])");
  EXPECT_EQ(refusal("frontend.window_x_m", "1"),
            "my.ini:12: unknown section [frontend]; did you mean [front_end]?");
  EXPECT_EQ(refusal("gui.colour", "1"),
            "my.ini:12: unknown section [gui]; the sections are [front_end] [log] [psi]");
  EXPECT_EQ(refusal("window_x_m", "1"), R"(my.ini:12: expected section.key, not "window_x_m")");
}

TEST(OptionTable, rejects_contradictory_descriptions) {
  double number = 30;
  int integer = 3;
  OptionTable table;
  EXPECT_THROW(table.number("x_m", number, any_number(), "m", ""), std::logic_error) << "no section yet";
  table.section("a", "");
  EXPECT_THROW(table.section("a", ""), std::logic_error);
  EXPECT_THROW(table.number("x_m", number, between(0, 20), "m", ""), std::logic_error)
      << "the default is out of range";
  EXPECT_THROW(table.angle_deg("x_deg", number, between(0, 360), ""), std::logic_error)
      << "the default is 30 radians";
  EXPECT_THROW(table.integer("n", integer, any_number().below(3), "", ""), std::logic_error);
  EXPECT_THROW(table.number("x_deg", number, any_number(), "", ""), std::logic_error)
      << "an angle described as a number";
  EXPECT_THROW(table.number("x_deg", number, any_number(), "deg", ""), std::logic_error);
  EXPECT_THROW(table.angle_deg("x", number, any_number(), ""), std::logic_error);
  number = std::nan("");
  EXPECT_THROW(table.number("x_m", number, any_number(), "m", ""), std::logic_error);
  number = 1;
  table.number("x_m", number, any_number(), "m", "");
  EXPECT_THROW(table.number("x_m", number, any_number(), "m", ""), std::logic_error)
      << "the key is described twice";
}

TEST_F(OptionTableTest, finds_options_by_their_old_names) {
  table_.alias("scan_matching", "front_end").alias("front_end.rounds", "front_end.passes");
  EXPECT_EQ(table_.option("scan_matching.rounds", "test").name(), "front_end.passes");
  EXPECT_EQ(table_.current_name("scan_matching.nodes"), "front_end.nodes");
  EXPECT_EQ(table_.current_name("front_end.nodes"), "front_end.nodes");
  EXPECT_TRUE(table_.knows("scan_matching.rounds"));
  EXPECT_TRUE(table_.knows("front_end.passes"));
  EXPECT_FALSE(table_.knows("scan_matching.seed"));
  EXPECT_FALSE(table_.knows("passes"));
}

TEST_F(OptionTableTest, rejects_contradictory_aliases) {
  EXPECT_THROW(table_.alias("front_end.rounds", "front_end.unknown"), std::logic_error);
  EXPECT_THROW(table_.alias("old", "unknown"), std::logic_error);
  EXPECT_THROW(table_.alias("front_end.nodes", "front_end.passes"), std::logic_error);
  EXPECT_THROW(table_.alias("log", "front_end"), std::logic_error);
  EXPECT_THROW(table_.alias("old", "front_end.passes"), std::logic_error);
  table_.alias("old", "front_end");
  EXPECT_THROW(table_.alias("old", "log"), std::logic_error);
}

TEST_F(OptionTableTest, only_set_any_changes_constants) {
  double reach_rad = 1;
  int count = 3;
  bool on = true;
  table_.constant("matching.reach_deg", reach_rad)
      .constant("matching.count", count)
      .constant("front_end.on", on);
  EXPECT_TRUE(table_.is_constant("matching.count"));
  EXPECT_FALSE(table_.knows("matching.count"));
  EXPECT_THROW(table_.constant("matching.count", count), std::logic_error);
  EXPECT_THROW(table_.obsolete("matching.count"), std::logic_error);
  EXPECT_NO_THROW(table_.require_section("matching", "my.ini:1"));
  table_.set("matching.count", "3", "my.ini:2");
  table_.set("front_end.on", "yes", "my.ini:3");
  EXPECT_THAT(table_.take_warnings(), testing::IsEmpty()) << "the value is that of the constant";
  table_.set("matching.count", "4", "my.ini:2");
  table_.set("front_end.on", "false", "my.ini:3");
  EXPECT_EQ(count, 3);
  EXPECT_TRUE(on);
  EXPECT_THAT(table_.take_warnings(),
              testing::ElementsAre("my.ini:2: front_end.on (always true), matching.count (always 3) have no "
                                   "effect any more; remove them"));
  table_.set_any("matching.reach_deg", "90", "test");
  table_.set_any("matching.count", "4", "test");
  table_.set_any("front_end.on", "no", "test");
  EXPECT_DOUBLE_EQ(reach_rad, M_PI / 2);
  EXPECT_EQ(count, 4);
  EXPECT_FALSE(on);
  EXPECT_EQ(table_.option_or_constant("matching.reach_deg", "test").text(), "90");
  EXPECT_THROW(table_.set_any("matching.count", "-4", "test"), UserError);
  EXPECT_THROW(table_.set_any("matching.count", "many", "test"), UserError);
  EXPECT_THROW(table_.constant("matching.share", reach_rad, between(0, 1)), std::logic_error);
  OptionTable other;
  double other_reach_rad = 0;
  int other_count = 0;
  bool other_on = true;
  other.constant("matching.reach_deg", other_reach_rad)
      .constant("matching.count", other_count)
      .constant("front_end.on", other_on);
  other.copy_constants(table_);
  EXPECT_EQ(other_count, 4);
  EXPECT_FALSE(other_on);
  table_.reset_constants();
  EXPECT_EQ(count, 3);
  EXPECT_THROW(table_.set("matching.cout", "4", "my.ini:4"), UserError) << "no such key";
  EXPECT_THROW(table_.set_any("matching.cout", "4", "test"), UserError);
}

TEST_F(OptionTableTest, accepts_obsolete_options_with_one_warning_for_each_file) {
  table_.obsolete("front_end.gone").obsolete("old.gone");
  EXPECT_FALSE(table_.knows("front_end.gone"));
  EXPECT_THROW(table_.obsolete("front_end.passes"), std::logic_error);
  table_.set("old.gone", "7", "my.ini:12");
  table_.set("front_end.gone", "any text", "my.ini:15");
  table_.set("old.gone", "8", "other.ini:2");
  EXPECT_THAT(table_.take_warnings(),
              testing::ElementsAre("my.ini:12: front_end.gone, old.gone have no effect any more; remove them",
                                   "other.ini:2: old.gone has no effect any more; remove it"));
  EXPECT_THAT(table_.take_warnings(), testing::IsEmpty());
}

}  // namespace
}  // namespace psi_slam
