// SPDX-License-Identifier: BSD-3-Clause
#include "command_line.h"

#include <gmock/gmock.h>

#include "app_run.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using Command = CommandLine::Command;

CommandLine parsed(const std::vector<std::string>& arguments) {
  CLI::App app;
  return parse_command_line(arguments, app);
}

/// Runs psi-slam with arguments that it must reject, and returns the error message.
std::string complaint(const std::vector<std::string>& arguments) {
  const AppRun run = run_app(arguments);
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, MatchesRegex("psi-slam: [^\n]+\n")) << "one line";
  return run.err;
}

TEST(CommandLine, accepts_options_before_and_after_the_log) {
  for (const CommandLine& line : {parsed({"-c", "my.ini", "--set", "a.b=1", "--set", "c.d=2", "my.log", "-o",
                                          "out", "--force", "--json"}),
                                  parsed({"my.log", "--output", "out", "--set=a.b=1", "--json",
                                          "--config=my.ini", "--set", "c.d=2", "--force"})}) {
    EXPECT_EQ(line.command, Command::kMap);
    EXPECT_EQ(line.log, "my.log");
    EXPECT_EQ(line.output, "out");
    EXPECT_EQ(line.config, "my.ini");
    EXPECT_THAT(line.settings, ElementsAre("a.b=1", "c.d=2"));
    EXPECT_TRUE(line.force && line.json);
    EXPECT_FALSE(line.quiet || line.verbose || line.seed || line.threads);
  }
}

TEST(CommandLine, an_override_does_not_take_the_log_as_its_value) {
  EXPECT_EQ(parsed({"-o", "out", "--set", "a.b=1", "my.log"}).log, "my.log");
  EXPECT_EQ(parsed({"check", "--set", "a.b=1", "my.log"}).log, "my.log");
}

TEST(CommandLine, knows_its_commands) {
  const CommandLine check = parsed({"check", "my.log", "-c", "my.ini", "--json", "--set", "a.b=1"});
  EXPECT_EQ(check.command, Command::kCheck);
  EXPECT_EQ(check.log, "my.log");
  EXPECT_EQ(check.config, "my.ini");
  EXPECT_TRUE(check.json);
  const CommandLine diff = parsed({"diff", "may", "june", "--aligned", "--tolerance-m", "0.2", "-o", "out"});
  EXPECT_EQ(diff.command, Command::kDiff);
  EXPECT_THAT(diff.inputs, ElementsAre("may", "june"));
  EXPECT_TRUE(diff.diff.aligned);
  EXPECT_EQ(diff.diff.tolerance_m, "0.2");
  EXPECT_EQ(parsed({"options"}).command, Command::kOptions);
  EXPECT_TRUE(parsed({"options", "--markdown"}).options.markdown);
  EXPECT_EQ(parsed({"options", "range"}).options.word, "range");
  EXPECT_EQ(parsed({"map", "my.log", "-o", "out"}).log, "my.log");
  const CommandLine eval = parsed({"eval", "a.tum", "true.relations", "--json"});
  EXPECT_EQ(eval.command, Command::kEval);
  EXPECT_EQ(eval.eval.trajectory, "a.tum");
  EXPECT_EQ(eval.eval.relations, "true.relations");
  const CommandLine gui = parsed({"gui", "a.log", "--seed"});
  EXPECT_EQ(gui.command, Command::kOtherProgram);
  EXPECT_STREQ(gui.other_program->program, "psi-slam-gui");
  EXPECT_THAT(gui.other_arguments, ElementsAre("a.log", "--seed"));
  EXPECT_EQ(parsed({"sweep", "a.log", "-o", "out"}).command, Command::kSweep);
  EXPECT_EQ(parsed({"--dump-config", "-c", "my.ini"}).command, Command::kDumpConfig);
}

TEST(CommandLine, wrong_usage_gives_one_sentence) {
  EXPECT_THAT(complaint({}), AllOf(HasSubstr("name the log"), HasSubstr("--help")));
  EXPECT_EQ(parsed({"my.log"}).output, "") << "default_output_folder() names it";
  EXPECT_THAT(complaint({"my.log", "-o"}), HasSubstr("--output"));
  EXPECT_THAT(complaint({"my.log", "-o", "out", "--colour"}), HasSubstr("there is no option \"--colour\""));
  EXPECT_THAT(complaint({"my.log", "-o", "out", "--forse"}), HasSubstr("did you mean \"--force\"?"));
  EXPECT_THAT(complaint({"a.log", "b.log", "-o", "out"}), HasSubstr("unexpected argument \"b.log\""));
  EXPECT_THAT(complaint({"chekc", "my.log"}), HasSubstr("no command \"chekc\"; did you mean \"check\"?"));
  EXPECT_THAT(complaint({"help", "chekc"}), HasSubstr("no command \"chekc\"; did you mean \"check\"?"));
  EXPECT_THAT(complaint({"map", "check", "my.log"}), HasSubstr("expected a log after map"));
  EXPECT_THAT(complaint({"-q", "map", "my.log", "-o", "out"}), HasSubstr("psi-slam map ..."));
  EXPECT_THAT(complaint({"-v", "gui", "a"}), HasSubstr("before its options: psi-slam gui ..."));
  EXPECT_THAT(complaint({"check"}), HasSubstr("psi-slam check LOG"));
  EXPECT_THAT(complaint({"check", "a.log", "b.log"}), HasSubstr("unexpected argument \"b.log\""));
  EXPECT_THAT(complaint({"-o", "out", "check", "a.log"}), HasSubstr("nothing is written"));
  EXPECT_THAT(complaint({"--dump-config", "my.log"}), HasSubstr("unexpected argument \"my.log\""));
  EXPECT_THAT(complaint({"options", "my.log"}), HasSubstr("my.log"));
  EXPECT_THAT(complaint({"my.log", "-o", "out", "-q", "-v"}), HasSubstr("--quiet contradicts --verbose"));
  EXPECT_THAT(complaint({"my.log", "-o", "out", "--seed"}), HasSubstr("--seed"));
}

TEST(CommandLine, errors_name_the_help_of_the_command) {
  for (const char* command : {"check", "diff", "live", "localize", "merge", "sweep"}) {
    const std::string help = std::string("(see psi-slam ") + command + " --help)\n";
    EXPECT_THAT(complaint({command}), EndsWith(help));
    EXPECT_THAT(complaint({command, "--foo"}), EndsWith(help));
    EXPECT_THAT(complaint({command, "--set"}), EndsWith(help));
  }
  EXPECT_THAT(complaint({"options", "range", "x"}), EndsWith("(see psi-slam options --help)\n"));
  EXPECT_THAT(complaint({"my.log", "-o"}), EndsWith("(see psi-slam --help)\n"));
  EXPECT_THAT(complaint({"my.log", "--foo"}), EndsWith("(see psi-slam --help)\n"));
}

TEST(CommandLine, prints_version_and_help) {
  const AppRun version = run_app({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, MatchesRegex("psi-slam [0-9.]+\n"));
  const AppRun help = run_app({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* option : {"--config", "--output", "--set", "--seed", "--threads", "--force", "--json",
                             "--quiet", "--verbose", "--dump-config", "--version", "check", "options", "LOG"})
    EXPECT_THAT(help.out, HasSubstr(option));
  EXPECT_EQ(run_app({"check", "--help"}).code, 0);
  EXPECT_EQ(run_app({"help"}).out, help.out);
  EXPECT_EQ(run_app({"help", "map"}).out, help.out);
  EXPECT_EQ(run_app({"help", "check"}).out, run_app({"check", "--help"}).out);
  EXPECT_THAT(run_app({"help", "check", "x"}).err, HasSubstr("unexpected argument \"x\""));
  EXPECT_EQ(help.err, "");
}

TEST(CommandLine, help_comes_before_or_after_the_command) {
  const std::string whole = run_app({"--help"}).out;
  const std::string check = run_app({"check", "--help"}).out;
  for (const char* word : {"help", "-h", "--help"}) {
    EXPECT_EQ(run_app({word}).out, whole);
    EXPECT_EQ(run_app({word, "map"}).out, whole) << word;
    EXPECT_EQ(run_app({word, "help"}).out, whole) << word;
    EXPECT_EQ(run_app({word, "check"}).out, check) << word;
    const CommandLine bench = parsed({word, "bench", "freiburg"});
    EXPECT_STREQ(bench.other_program->program, "psi-slam-bench") << word;
    EXPECT_THAT(bench.other_arguments, ElementsAre("freiburg", "--help")) << word;
  }
  EXPECT_EQ(run_app({"map", "--help"}).out, whole);
  EXPECT_EQ(run_app({"--help", "my.log"}).out, whole);
  EXPECT_EQ(run_app({"-h", "check", "my.log"}).out, check);
}

}  // namespace
}  // namespace psi_slam
