// SPDX-License-Identifier: BSD-3-Clause
// Tests the manual page and the bash completion that are generated for an imaginary program.
#include <gmock/gmock.h>

#include "command_words.h"
#include "document_options.h"
#include "help_format.h"

namespace psi_slam {
namespace {

using ::testing::ContainsRegex;
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
    app_.add_subcommand("brew", "Make tea");
    app_.add_subcommand("pot", "Run the teapot");
    CLI::App* const help = app_.add_subcommand("help", "Explain a command");
    help->add_option("COMMAND", texts_, "Command to explain")->type_name("");
    for (const char* command : {"brew", "pot", "help"}) app_.get_subcommand(command)->set_help_flag();
    table_->section("tea", "Tea")
        .flag("milk", milk_, "with milk")
        .choice("kind", kind_, {{"green", 0}, {"black", 1}}, "");
  }

  std::string text_;
  std::vector<std::string> texts_;
  double minutes_ = 3;
  std::vector<int> times_{1, 2};
  bool milk_ = false;
  int kind_ = 0;
  CLI::App app_{"tea makes tea - hot. Or not.", "tea"};
  std::shared_ptr<OptionTable> table_ = std::make_shared<OptionTable>();
  ProgramFacts facts_{{"Drunk", "Spilt", "No tea"}, table_, "brew", {{"pot", "teapot"}}};
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
  EXPECT_EQ(value_name(*app_.get_option("--minutes")), "NUMBER") << "without CLI11's words on its range";
}

TEST_F(Documents, the_page_has_the_name_all_options_and_the_default) {
  const std::string page = man_page(app_, facts_);
  EXPECT_THAT(page, HasSubstr("tea \\- makes tea \\- hot\n"));
  EXPECT_THAT(page, HasSubstr("\\fBtea\\fR [\\fIOPTION\\fR]... \\fICUP\\fR\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fB\\-l\\fR, \\fB\\-\\-leaves\\fR \\fIFILE\\fR\n\\&\\(aqGreen\\(aq or \\eblack\n"));
  EXPECT_THAT(page, HasSubstr("\\&.3 to 5 (default 3)"));
  EXPECT_THAT(page, HasSubstr(".SS \"tea pour\""));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
  EXPECT_THAT(page, Not(HasSubstr("spill")));
  EXPECT_THAT(page, HasSubstr(".SH \"EXIT STATUS\"\n.TP\n0\nDrunk\n.TP\n1\nSpilt\n.TP\n2\nNo tea\n"));
}

TEST_F(Documents, the_page_says_where_the_options_of_commands_are_explained) {
  const std::string page = man_page(app_, facts_);
  EXPECT_THAT(page, HasSubstr("\\fBtea brew\\fR [\\fIOPTION\\fR]... \\fICUP\\fR\n"));
  EXPECT_THAT(page, HasSubstr("\\fBtea pot\\fR [\\fIARGUMENT\\fR]...\n"));
  EXPECT_THAT(page, HasSubstr("\\fBtea help\\fR [\\fICOMMAND\\fR]...\n"));
  EXPECT_THAT(page, HasSubstr("Make tea\n.PP\nTakes the options above.\n"));
  EXPECT_THAT(page, HasSubstr("Run the teapot\n.PP\nTakes the arguments of \\fBteapot\\fR(1).\n"));
}

TEST_F(Documents, help_shows_values_without_notes_of_the_option_library) {
  format_help(app_);
  const std::string help = app_.help();
  EXPECT_THAT(help, ContainsRegex("--minutes NUMBER +\\.3 to 5 \\(default 3\\)\n"));
  EXPECT_THAT(help, ContainsRegex("  CUP +Where to\n"));
  EXPECT_THAT(help, ContainsRegex("--leaves FILE +'Green'"));
  app_.add_option("--times", times_, "How often")->check(CLI::Range(1, 9))->capture_default_str()->required();
  EXPECT_THAT(app_.help(), ContainsRegex("--times N +How often \\(default 1,2\\) \\(required\\)\n"));
  EXPECT_THAT(app_.get_subcommand("help")->help(),
              ContainsRegex("  COMMAND \\.\\.\\. +Command to explain\n"));
}

TEST_F(Documents, the_settings_page_has_every_option) {
  const std::string page = settings_man_page(*table_, "tea 1.0");
  EXPECT_THAT(page, HasSubstr(".SH \"[tea]\"\nTea.\n"));
  EXPECT_THAT(page, HasSubstr("\\fBkind\\fR\n"));
  EXPECT_THAT(page, HasSubstr("one of green, black; default green"));
}

TEST_F(Documents, completion_knows_options_commands_and_values) {
  const std::string script = bash_completion(app_, facts_);
  EXPECT_THAT(script, HasSubstr("tea.milk= tea.kind="));
  EXPECT_THAT(script, HasSubstr("tea.kind) values=\"green black\""));
  EXPECT_THAT(script, HasSubstr("-W \"pour brew pot help\""));
  EXPECT_THAT(script, HasSubstr("\"pour --into\")"));
  EXPECT_THAT(script, Not(HasSubstr("secret")));
  EXPECT_THAT(script, HasSubstr("\"brew --leaves\")"));
  EXPECT_THAT(script, HasSubstr("\"help help\")"));
  EXPECT_THAT(script, HasSubstr("pot) _tea_program pot teapot; return ;;"));
  const std::string alone = bash_completion(app_, ProgramFacts());
  EXPECT_THAT(alone, Not(HasSubstr("_setting")));
  EXPECT_THAT(alone, Not(HasSubstr("_program")));
}

TEST_F(Documents, hidden_options_work_without_required_arguments) {
  add_document_options(app_, facts_);
  try {
    app_.parse("--man-page");
    FAIL() << "the parsing went on";
  } catch (const CLI::Success& asked) {
    std::ostringstream out;
    EXPECT_EQ(app_.exit(asked, out, out), 0);
    EXPECT_EQ(out.str(), man_page(app_, facts_));
  }
  EXPECT_THAT(app_.help(), Not(HasSubstr("man-page")));
}

}  // namespace
}  // namespace psi_slam
