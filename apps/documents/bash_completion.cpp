// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "command_words.h"
#include "document_options.h"

namespace psi_slam {
namespace {

/// Start of the completion function: finds the word to complete, the option before it, and the command. Bash
/// splits words at "=" and ":", which settings contain, so the script splits the line again at blanks. kEnd
/// removes from each answer the part up to the last "=" or ":", which bash keeps on the line.
constexpr const char* kBegin = R"(@FUNCTION@_answer() {
  local answer
  while IFS= read -r answer; do
    COMPREPLY+=("$answer")
  done < <(compgen "$@")
}

@FUNCTION@() {
  local line=${COMP_LINE:0:$COMP_POINT} prefix="" previous="" command="" word i
  local -a words
  if [[ -n ${ZSH_VERSION-} ]]; then
    words=("${COMP_WORDS[@]:0:$((COMP_CWORD + 1))}")
  else
    # shellcheck disable=SC2162  # backslashes escape blanks, as in bash
    read -a words <<<"$line"
    [[ $line == *[[:space:]] ]] && words+=("")
  fi
  local last=$((${#words[@]} - 1))
@PROGRAMS@  local whole=${words[last]} current=${words[last]}
  for ((i = 1; i < last; ++i)); do
    word=${words[i]}
    if [[ -z $command && " @COMMANDS@ " == *" $word "* ]]; then command=$word; fi
    if [[ " @TAKE_VALUES@ " == *" $word "* ]]; then ((++i)); fi
  done
  ((last > 0)) && previous=${words[last - 1]}
  if [[ $current == --*=* ]]; then
    previous=${current%%=*}
    prefix=$previous=
    current=${current#*=}
  fi
  COMPREPLY=()
)";

/// Completes the command line of another program, which the command $1 starts. $2 is the other program. The
/// line is rewritten as if it began with that program.
constexpr const char* kProgramFunction = R"(@FUNCTION@_folder=${BASH_SOURCE[0]:-}
[[ -z ${ZSH_VERSION-} ]] || eval '@FUNCTION@_folder=${(%):-%x}'
@FUNCTION@_folder=${@FUNCTION@_folder%/*}

@FUNCTION@_program() {
  local rest=${COMP_LINE#*[[:space:]]"$1"} script=$@FUNCTION@_folder/$2
  COMP_POINT=$((COMP_POINT - ${#COMP_LINE} + ${#2} + ${#rest}))
  COMP_LINE=$2$rest
  COMP_WORDS=("$2" "${COMP_WORDS[@]:2}")
  COMP_CWORD=$((COMP_CWORD - 1))
  COMPREPLY=()
  if ! declare -f "_${2//-/_}" >/dev/null; then
    [[ -r $script ]] || return 0
    # shellcheck disable=SC1090  # the script of the other program
    source "$script"
  fi
  "_${2//-/_}"
}

)";

constexpr const char* kEnd = R"(  local broken=${whole%"${whole##*[=:]}"}
  if [[ -n $broken && ${COMP_WORDBREAKS-} == *[=:]* ]]; then COMPREPLY=("${COMPREPLY[@]#"$broken"}"); fi
}
complete -o nosort -F @FUNCTION@ @PROGRAM@ 2>/dev/null || complete -F @FUNCTION@ @PROGRAM@
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : shown_commands(app)) names.push_back(command->get_name());
  return joined(names, " ");
}

std::vector<std::string> names_with_values(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : shown_options(app))
    if (kind_of_value(*option) != WordKind::kNothing)
      for (const std::string& name : typed_names(*option)) names.push_back(name);
  for (const CLI::App* command : shown_commands(app))
    for (const std::string& name : names_with_values(*command)) names.push_back(name);
  return names;
}

/// Lines that complete the arguments of other programs.
std::string program_branches(const std::map<std::string, std::string>& programs) {
  std::string text;
  for (const auto& [command, program] : programs)
    text += "      " + command + ") @FUNCTION@_program " + command + ' ' + program + "; return ;;\n";
  return text.empty() ? "" : "  if ((last > 1)); then\n    case ${words[1]} in\n" + text + "    esac\n  fi\n";
}

std::string answer(const std::string& compgen, const std::string& option = "") {
  return "@FUNCTION@_answer -P \"$prefix\" " + compgen + " -- \"$current\"" +
         (option.empty() ? "" : "\n      compopt -o " + option + " 2>/dev/null");
}

std::string answer_for(WordKind kind, const std::string& function) {
  if (kind == WordKind::kFile) return answer("-f", "filenames");
  if (kind == WordKind::kFolder) return answer("-d", "filenames");
  return kind == WordKind::kSetting ? function + "_setting" : ":";
}

/// Branches of `case "$command $previous" in` that complete an option's value, one for each kind of value.
/// `app` has the options of the command.
std::string value_branches(const CLI::App& app, const std::string& command, const std::string& function) {
  std::map<WordKind, std::vector<std::string>> patterns;
  for (const CLI::Option* option : shown_options(app))
    if (const WordKind kind = kind_of_value(*option); kind != WordKind::kNothing)
      for (const std::string& name : typed_names(*option))
        patterns[kind].push_back('"' + command + ' ' + name + '"');
  std::string text;
  for (const auto& [kind, names] : patterns)
    text += "    " + joined(names, " | ") + ")\n      " + answer_for(kind, function) + "\n      ;;\n";
  return text;
}

/// Branch for a word that is not the value of an option. Completes options of `app` if the word begins with a
/// dash, and `commands` and files otherwise.
std::string word_branch(const CLI::App& app, const std::string& command, const std::string& commands) {
  std::vector<std::string> options;
  for (const CLI::Option* option : shown_options(app))
    for (const std::string& name : typed_names(*option)) options.push_back(name);
  std::string text = "    \"" + command + " \"*)\n      if [[ $current == -* ]]; then\n        " +
                     answer("-W \"" + joined(options, " ") + '"') + "\n      else\n";
  const std::string files = shown_positionals(app).empty() ? "" : "-f ";
  const std::string words = commands.empty() ? "" : "-W \"" + commands + "\" ";
  text += files.empty() && words.empty() ? "        :\n" : "        " + answer(files + words) + '\n';
  if (!files.empty()) text += "        compopt -o filenames 2>/dev/null\n";
  return text + "      fi\n      ;;\n";
}

/// True if the arguments of the command are the name of another command, as those of "help".
bool explains_commands(const CLI::App& command) {
  const auto positionals = shown_positionals(command);
  return !positionals.empty() && kind_of_value(*positionals.front()) == WordKind::kCommand;
}

/// All branches for the words after a command; `app` is the program. None for a command that starts a
/// program.
std::string command_branches(const CLI::App& command, const CLI::App& app, const ProgramFacts& facts,
                             const std::string& function) {
  const std::string name = command.get_name();
  if (facts.programs.count(name) > 0) return "";
  if (explains_commands(command))
    return "    \"" + name + ' ' + name + "\")\n      " + answer("-W \"" + command_names(app) + '"') +
           "\n      ;;\n";
  const CLI::App& options = name == facts.optional_command ? app : command;
  return value_branches(options, name, function) + word_branch(options, name, "");
}

/// Shell function that completes SECTION.KEY=VALUE.
std::string setting_function(const OptionTable& settings, const std::string& function) {
  std::vector<std::string> keys;
  std::map<std::string, std::vector<std::string>> keys_of_values;
  for (const OptionSection& section : settings.sections()) {
    for (const Option& option : section.options) {
      keys.push_back(option.name() + '=');
      if (option.type == OptionType::kFlag) keys_of_values["true false"].push_back(option.name());
      if (option.type == OptionType::kChoice)
        keys_of_values[joined(option.choices, " ")].push_back(option.name());
      if (option.may_be_auto) keys_of_values["auto"].push_back(option.name());
    }
  }
  std::string text =
      function + "_setting() {\n  local values=\"\"\n  if [[ $current != *=* ]]; then\n      " +
      answer("-W \"" + joined(keys, " ") + '"', "nospace") + "\n    return\n  fi\n  case ${current%%=*} in\n";
  for (const auto& [values, names] : keys_of_values)
    text += "    " + joined(names, " | ") + ") values=\"" + values + "\" ;;\n";
  return text +
         "  esac\n  @FUNCTION@_answer -P \"$prefix${current%%=*}=\" -W \"$values\" -- "
         "\"${current#*=}\"\n}\n\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app, const ProgramFacts& facts) {
  const std::string function = '_' + replaced(app.get_name(), "-", "_");
  std::string script = "# bash completion for " + app.get_name() + ", generated from its command line\n\n";
  if (facts.settings) script += setting_function(*facts.settings, function);
  if (!facts.programs.empty()) script += kProgramFunction;
  std::string begin = replaced(kBegin, "@COMMANDS@", command_names(app));
  begin = replaced(begin, "@TAKE_VALUES@", joined(names_with_values(app), " "));
  script += replaced(begin, "@PROGRAMS@", program_branches(facts.programs));
  script += "  case \"$command $previous\" in\n" + value_branches(app, "", function) +
            word_branch(app, "", command_names(app));
  for (const CLI::App* command : shown_commands(app))
    script += command_branches(*command, app, facts, function);
  script += "  esac\n";
  return replaced(replaced(script + kEnd, "@FUNCTION@", function), "@PROGRAM@", app.get_name());
}

}  // namespace psi_slam
