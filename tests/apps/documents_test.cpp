// SPDX-License-Identifier: BSD-3-Clause
// Tests the manual page and the bash completion that are generated for an imaginary program.
#include <gmock/gmock.h>

#include "command_words.h"
#include "document_options.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Documents : public testing::Test {
 protected:
  Documents() {
    app_.set_version_flag("--version", "tea 1.0", "Print the version");
    app_.add_option("CUP", text_, "Where to")->required();
    app_.add_option("-l,--leaves", text_, "'Green' or \\black")->type_name("FILE");
    app_.add_option("--minutes", minutes_, ".3 to 5")->check(CLI::Range(0.3, 5.0))->capture_default_str();
    app_.add_flag("--secret")->group("");
    CLI::App* const pour = app_.add_subcommand("pour", "Pour it");
    pour->add_option("--into", text_, "Pot")->type_name("DIR");
    app_.add_subcommand("spill")->group("");
    table_.section("tea", "Tea")
        .flag("milk", milk_, "with milk")
        .choice("kind", kind_, {{"green", 0}, {"black", 1}}, "");
  }

  std::string text_;
  double minutes_ = 3;
  bool milk_ = false;
  int kind_ = 0;
  CLI::App app_{"tea makes tea - hot. Or not.", "tea"};
  OptionTable table_;
};

TEST(RoffText, escapes_special_characters) {
  EXPECT_EQ(roff_text("a-b \\n 'x' \"y\" ~ ^ `"), "a\\-b \\en \\(aqx\\(aq \\(dqy\\(dq \\(ti \\(ha \\(ga");
  EXPECT_EQ(roff_text(".SH\n.x\n'y a.b"), "\\&.SH\n\\&.x\n\\&\\(aqy a.b");
  EXPECT_EQ(roff_text("Kümmerle"), "Kümmerle");
}

TEST_F(Documents, kinds_of_values_follow_from_their_names) {
  EXPECT_EQ(kind_of_value(*app_.get_option("--leaves")), WordKind::kFile);
  EXPECT_EQ(kind_of_value(*app_.get_option("CUP")), WordKind::kFile);
  EXPECT_EQ(kind_of_value(*app_.get_option("--minutes")), WordKind::kOther);
  EXPECT_EQ(kind_of_value(*app_.get_option("--version")), WordKind::kNothing);
  EXPECT_EQ(value_name(*app_.get_option("--minutes")), "FLOAT") << "without CLI11's words on its range";
}

TEST_F(Documents, the_page_has_the_name_all_options_and_the_default) {
  const std::string page = man_page(app_);
  EXPECT_THAT(page, HasSubstr("tea \\- makes tea \\- hot\n"));
  EXPECT_THAT(page, HasSubstr("\\fBtea\\fR [\\fIOPTION\\fR]... \\fICUP\\fR\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fB\\-l\\fR, \\fB\\-\\-leaves\\fR \\fIFILE\\fR\n\\&\\(aqGreen\\(aq or \\eblack\n"));
  EXPECT_THAT(page, HasSubstr("\\&.3 to 5 (default 3)"));
  EXPECT_THAT(page, HasSubstr(".SS \"tea pour\""));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
  EXPECT_THAT(page, Not(HasSubstr("spill")));
}

TEST_F(Documents, the_settings_page_has_every_option) {
  const std::string page = settings_man_page(table_, "tea 1.0");
  EXPECT_THAT(page, HasSubstr(".SH \"[tea]\"\nTea.\n"));
  EXPECT_THAT(page, HasSubstr("\\fBkind\\fR\n"));
  EXPECT_THAT(page, HasSubstr("one of green, black; default green"));
}

TEST_F(Documents, completion_knows_options_commands_and_values) {
  const std::string script = bash_completion(app_, &table_);
  EXPECT_THAT(script, HasSubstr("tea.milk= tea.kind="));
  EXPECT_THAT(script, HasSubstr("tea.kind) values=\"green black\""));
  EXPECT_THAT(script, HasSubstr("-W \"pour\""));
  EXPECT_THAT(script, HasSubstr("\"pour --into\")"));
  EXPECT_THAT(script, Not(HasSubstr("secret")));
  EXPECT_THAT(bash_completion(app_, nullptr), Not(HasSubstr("_setting")));
  EXPECT_THAT(bash_completion(app_, nullptr), Not(HasSubstr("_program")));
  EXPECT_THAT(bash_completion(app_, nullptr, {{"pour", "teapot"}}),
              HasSubstr("pour) _tea_program pour teapot; return ;;"));
}

TEST_F(Documents, hidden_options_work_without_required_arguments) {
  add_document_options(app_);
  try {
    app_.parse("--man-page");
    FAIL() << "the parsing went on";
  } catch (const CLI::Success& asked) {
    std::ostringstream out;
    EXPECT_EQ(app_.exit(asked, out, out), 0);
    EXPECT_EQ(out.str(), man_page(app_));
  }
  EXPECT_THAT(app_.help(), Not(HasSubstr("man-page")));
}

}  // namespace
}  // namespace psi_slam
