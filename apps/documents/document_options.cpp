// SPDX-License-Identifier: BSD-3-Clause
#include "document_options.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <sstream>

#include "base/config/ini_file.h"
#include "command_words.h"
#include "help_format.h"

namespace psi_slam {
namespace {

/// Bold text, for words that the user types literally.
std::string roff_bold(std::string_view text) {
  return "\\fB" + roff_text(text) + "\\fR";
}

/// Italic text, for placeholders that the user replaces.
std::string roff_italic(std::string_view text) {
  return "\\fI" + roff_text(text) + "\\fR";
}

std::string roff_section(std::string_view title) {
  return ".SH \"" + roff_text(title) + "\"\n";
}

/// Paragraph with a hanging tag. `tag` and `text` must be troff markup.
std::string roff_item(const std::string& tag, const std::string& text) {
  return ".TP\n" + tag + '\n' + text + '\n';
}

std::string heading(const std::string& name, int section, const std::string& version) {
  const std::string manual = section == 1 ? "User Commands" : "File Formats";
  std::string upper = name;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return ".TH \"" + roff_text(upper) + "\" " + std::to_string(section) + " \"\" \"" + roff_text(version) +
         "\" \"" + manual + "\"\n";
}

/// First clause of the program's description, without the program's name and with a lower-case first letter.
std::string in_a_line(const CLI::App& app) {
  std::string text = app.get_description();
  const std::string name = app.get_name() + ' ';
  if (text.compare(0, name.size(), name) == 0) text.erase(0, name.size());
  text.erase(std::min(text.find_first_of(".:"), text.size()));
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string synopsis(const CLI::App& app, const std::string& program) {
  std::string line = roff_bold(program);
  if (!shown_options(app).empty()) line += " [" + roff_italic("OPTION") + "]...";
  for (const CLI::Option* positional : shown_positionals(app)) {
    const std::string name = roff_italic(positional->get_name(true));
    line += positional->get_required() ? ' ' + name : " [" + name + ']';
    if (takes_many(*positional)) line += "...";
  }
  return line;
}

/// Synopsis of a command; `app` is the program.
std::string command_synopsis(const CLI::App& command, const CLI::App& app, const ProgramFacts& facts) {
  const std::string name = command.get_name();
  const std::string words = app.get_name() + ' ' + name;
  if (facts.programs.count(name) > 0) return roff_bold(words) + " [" + roff_italic("ARGUMENT") + "]...";
  return synopsis(name == facts.optional_command ? app : command, words);
}

std::string option_item(const CLI::Option& option) {
  std::string tag;
  for (const std::string& name : typed_names(option)) tag += (tag.empty() ? "" : ", ") + roff_bold(name);
  if (const std::string value = value_name(option); !value.empty()) tag += ' ' + roff_italic(value);
  return roff_item(tag, roff_text(option_text(option)));
}

std::string option_items(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* positional : shown_positionals(app))
    text += roff_item(roff_italic(positional->get_name(true)), roff_text(positional->get_description()));
  for (const CLI::Option* option : shown_options(app)) text += option_item(*option);
  return text;
}

/// What a command takes: its options, or where they are explained.
std::string command_items(const CLI::App& command, const ProgramFacts& facts) {
  if (command.get_name() == facts.optional_command) return ".PP\nTakes the options above.\n";
  const auto program = facts.programs.find(command.get_name());
  if (program == facts.programs.end()) return option_items(command);
  return ".PP\nTakes the arguments of " + roff_bold(program->second) + "(1).\n";
}

std::string commands(const CLI::App& app, const ProgramFacts& facts) {
  std::string text;
  for (const CLI::App* command : shown_commands(app))
    text += ".SS \"" + roff_text(app.get_name() + ' ' + command->get_name()) + "\"\n" +
            roff_text(command->get_description()) + '\n' + command_items(*command, facts);
  return text.empty() ? "" : roff_section("COMMANDS") + text;
}

std::string footer(const CLI::App& app) {
  constexpr std::string_view kTitle = "\nExamples:\n";
  const std::string text = app.get_footer();
  if (text.empty()) return "";
  if (text.compare(0, kTitle.size(), kTitle) != 0) return roff_section("NOTES") + roff_text(text) + '\n';
  return roff_section("EXAMPLES") + ".PP\n.RS 4\n.nf\n" + roff_text(text.substr(kTitle.size())) +
         (text.back() == '\n' ? "" : "\n") + ".fi\n.RE\n";
}

std::string see_also(const std::string& name) {
  std::string text;
  std::istringstream programs(PSI_SLAM_PROGRAMS);
  for (std::string other; programs >> other;)
    if (name != other) text += roff_bold(other) + "(1), ";
  if (name == "psi-slam.ini") return text.substr(0, text.size() - 2) + '\n';
  return text + roff_bold("psi-slam.ini") + "(5)\n";
}

}  // namespace

std::string roff_text(std::string_view text) {
  static const std::map<char, const char*> kEscapes{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                    {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"},
                                                    {'"', "\\(dq"}};
  std::string roff;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) roff += "\\&";
    line_begins = c == '\n';
    const auto escape = kEscapes.find(c);
    roff += escape == kEscapes.end() ? std::string(1, c) : escape->second;
  }
  return roff;
}

std::string man_page(const CLI::App& app, const ProgramFacts& facts) {
  const std::string& name = app.get_name();
  std::string page = heading(name, 1, app.version());
  page += roff_section("NAME") + roff_text(name) + " \\- " + roff_text(in_a_line(app)) + '\n';
  page += roff_section("SYNOPSIS");
  const bool only_commands = app.get_require_subcommand_min() > 0;
  if (!only_commands) page += synopsis(app, name) + '\n';
  for (const CLI::App* command : shown_commands(app))
    page += (page.compare(page.size() - 11, 11, "\"SYNOPSIS\"\n") == 0 ? "" : ".br\n") +
            command_synopsis(*command, app, facts) + '\n';
  page += roff_section("DESCRIPTION") + roff_text(app.get_description()) + '\n';
  page += roff_section("OPTIONS") + option_items(app);
  page += commands(app, facts);
  page += roff_section("EXIT STATUS");
  for (std::size_t code = 0; code < facts.exit_codes.size(); ++code)
    page += roff_item(std::to_string(code), roff_text(facts.exit_codes[code]));
  page += footer(app);
  return page + roff_section("SEE ALSO") + see_also(name);
}

std::string settings_man_page(const OptionTable& table, const std::string& version) {
  std::string page = heading("psi-slam.ini", 5, version);
  page += roff_section("NAME") + "psi\\-slam.ini \\- settings of psi\\-slam and psi\\-slam\\-gui\n";
  page +=
      roff_section("DESCRIPTION") +
      roff_text(
          "A settings file has sections in brackets and lines KEY = VALUE. Comments begin with a semicolon, "
          "or with a hash at the start of a line or after a space. Options that a file leaves out keep their "
          "defaults. A line include = FILE before the first section takes the values of another file, which "
          "this file may override. Unknown keys and values out of range are errors.") +
      "\n" + roff_bold("psi-slam --dump-config") + '\n' + roff_text("prints a file with every option.") +
      '\n' + roff_bold("--set SECTION.KEY=VALUE") + '\n' + roff_text("changes one option for one run.") +
      '\n';
  for (const OptionSection& section : table.sections()) {
    page += roff_section('[' + section.name + ']') + roff_text(section.title + '.') + '\n';
    for (const Option& option : section.options)
      page += roff_item(roff_bold(option.key),
                        roff_text(option.help) + "\n.br\n" +
                            roff_text(option.values() + "; default " + ini_value_text(option.default_text)));
  }
  return page + roff_section("SEE ALSO") + see_also("psi-slam.ini");
}

void add_document_options(CLI::App& app, const ProgramFacts& facts) {
  const auto add_hidden = [&app](const std::string& name, const std::function<std::string()>& text) {
    // CLI11 appends a newline to the text of --version, so the last newline of the document is removed.
    const auto print = [text] {
      std::string document = text();
      if (!document.empty()) document.pop_back();
      throw CLI::CallForVersion(document, 0);
    };
    app.add_flag_callback(name, print)->group("");
  };
  add_hidden("--man-page", [&app, facts] { return man_page(app, facts); });
  add_hidden("--bash-completion", [&app, facts] { return bash_completion(app, facts); });
  if (facts.settings)
    add_hidden("--settings-man-page",
               [&app, settings = facts.settings] { return settings_man_page(*settings, app.version()); });
  format_help(app);
}

}  // namespace psi_slam
