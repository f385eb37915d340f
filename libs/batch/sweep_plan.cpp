// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_plan.h"

#include <algorithm>
#include <map>

#include "base/file_checksum.h"
#include "batch/kept_run.h"
#include "psi_slam/user_error.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRuns = 1'000'000;
constexpr std::size_t kFolderDigits = 16;  // number of digits of the key in a folder name

/// One option that varies, and its values.
struct Choice {
  std::string column;
  std::vector<std::string> values;
};

std::string stem_of(const fs::path& log) {
  const std::string file = log.filename().string();
  return log_name_of(file).value_or(file);
}

void require_file(const fs::path& path, const std::string& what) {
  if (!fs::is_regular_file(path)) throw UserError(what + path.string() + " is not a file. Check the path");
}

void measure(SweepLog& log) {
  log.sha256 = sha256_of_log(log.log);
  if (!fs::is_directory(log.log)) {
    log.bytes = fs::file_size(log.log);
    return;
  }
  for (const auto& entry : fs::recursive_directory_iterator(log.log))
    if (entry.is_regular_file()) log.bytes += entry.file_size();
}

/// Path of NAME + `ending` in `folder`, or beside the log if `folder` is empty. Empty if there is no such
/// file.
fs::path found(const fs::path& log, const std::string& folder, const char* ending) {
  const fs::path path = (folder.empty() ? log.parent_path() : fs::path(folder)) / (stem_of(log) + ending);
  return fs::is_regular_file(path) ? path : fs::path();
}

SweepLog log_of(const std::string& argument, const SweepRequest& request) {
  SweepLog log;
  log.log = argument;
  // Removes the slash at the end of "folder/".
  if (log.log.filename().empty()) log.log = log.log.parent_path();
  const std::size_t at = argument.rfind('@');
  if (at != std::string::npos && !fs::exists(log.log)) {  // a file name may contain @
    log.log = argument.substr(0, at);
    log.ini = argument.substr(at + 1);
    require_file(log.ini, "the settings of " + log.log.string() + ": ");
  } else {
    log.ini = found(log.log, request.ini_folder, ".ini");
  }
  if (!fs::is_directory(log.log)) require_file(log.log, "the log ");
  log.name = stem_of(log.log);
  measure(log);
  fs::path relations = request.relations;
  if (relations.empty())
    relations = found(log.log, {}, ".relations");
  else
    require_file(relations, "--relations: ");
  if (relations.empty()) return log;
  log.relations = relations;
  log.relations_sha256 = sha256_of_file(relations);
  return log;
}

std::vector<SweepLog> logs_of(const SweepRequest& request) {
  if (request.logs.empty())
    throw UserError("sweep: no log is given: name the logs, as in psi-slam sweep LOG... -o DIR");
  if (!request.relations.empty() && request.logs.size() > 1)
    throw UserError("--relations works with one log only: for several, put NAME.relations beside each log");
  if (!request.ini_folder.empty() && !fs::is_directory(request.ini_folder))
    throw UserError("--ini: " + request.ini_folder +
                    " is not a folder, expected a folder with a file NAME.ini for each log");
  std::map<std::string, int> names;
  std::vector<SweepLog> logs;
  for (const std::string& argument : request.logs) {
    logs.push_back(log_of(argument, request));
    ++names[logs.back().name];
  }
  for (SweepLog& log : logs)
    if (names[log.name] > 1) log.name = log.log.string();
  return logs;
}

Choice choice_of(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos)
    throw UserError("--set: expected SECTION.KEY=VALUE,VALUE,...: " + assignment);
  Choice choice{assignment.substr(0, equals), {}};
  if (choice.column == "run.seed" || choice.column == "run.threads")
    throw UserError("--set: set " + choice.column + " of a sweep with " +
                    (choice.column == "run.seed" ? "--seeds" : "--threads"));
  const bool is_list = choice.column == "log.laser" || choice.column == "log.scan_topic" ||
                       choice.column == "log.laser_mounts";
  if (is_list && assignment.find(',', equals) != std::string::npos)
    throw UserError(
        "--set: " + choice.column +
        " is a list, and --set splits values at commas: put the list into a settings file, -c INI");
  std::size_t begin = equals + 1;
  for (std::size_t comma = 0; comma != std::string::npos; begin = comma + 1) {
    comma = assignment.find(',', begin);
    choice.values.push_back(assignment.substr(begin, comma == std::string::npos ? comma : comma - begin));
  }
  return choice;
}

std::vector<Choice> choices_of(const SweepRequest& request) {
  const BoundSettings defaults;
  const auto name = [&](const Choice& choice) { return defaults.table.current_name(choice.column); };
  std::vector<Choice> choices;
  if (!request.configs.empty()) choices.push_back({"config", request.configs});
  for (const std::string& assignment : request.choices) {
    Choice choice = choice_of(assignment);
    if (defaults.table.is_ignored(choice.column))
      throw UserError("--set: " + choice.column +
                      " is not an option, so all runs would be equal. psi-slam options lists the options");
    for (const Choice& other : choices)
      if (name(other) == name(choice))
        throw UserError("--set: " + choice.column + " is set twice: give all values at once, " +
                        choice.column + "=VALUE,VALUE");
    choices.push_back(std::move(choice));
  }
  return choices;
}

/// All combinations of one value of each choice; the last choice varies fastest.
std::vector<std::vector<std::string>> combinations(const std::vector<Choice>& choices) {
  std::vector<std::vector<std::string>> all(1);
  for (const Choice& choice : choices) {
    if (all.size() * choice.values.size() > kMostRuns)
      throw UserError("--set: more than " + std::to_string(kMostRuns) + " combinations. Give fewer values");
    std::vector<std::vector<std::string>> longer;
    for (const std::vector<std::string>& values : all) {
      for (const std::string& value : choice.values) {
        longer.push_back(values);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

/// Sets all options except the seed, for the runs of a log with one combination of values.
void set_up(BoundSettings& bound, const SweepLog& log, const std::vector<Choice>& choices,
            const std::vector<std::string>& values, int threads) {
  bound.load(log.ini, {});
  std::vector<std::string> assignments;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i].column == "config")
      bound.load(values[i], {});
    else
      assignments.push_back(choices[i].column + '=' + values[i]);
  }
  bound.load({}, assignments);
  bound.table.set("run.threads", std::to_string(threads), "--threads");
  check(bound.settings);
}

std::string key_of(const SweepLog& log, const std::string& settings, const std::string& program_sha256) {
  return sha256_of_text(log.sha256 + '\n' + log.relations_sha256 + '\n' + program_sha256 + '\n' + settings);
}

std::string run_text(const SweepPlan& plan, const SweepRun& run) {
  std::string text = plan.logs[run.log].name;
  for (std::size_t i = 0; i < plan.columns.size(); ++i) text += ", " + plan.columns[i] + "=" + run.values[i];
  return text;
}

void require_all_different(const SweepPlan& plan) {
  std::map<std::string, const SweepRun*> known;
  for (const SweepRun& run : plan.runs)
    if (const auto [other, is_new] = known.emplace(run.key, &run); !is_new)
      throw UserError("two runs of the sweep would be equal: " + run_text(plan, *other->second) + " and " +
                      run_text(plan, run) + ". Remove one of the two" +
                      (plan.warnings.empty() ? "" : ". " + plan.warnings.front()));
}

/// Removes the columns of choices with a single value.
void keep_what_varies(SweepPlan& plan, const std::vector<Choice>& choices) {
  for (std::size_t i = choices.size(); i-- > 0;) {
    if (choices[i].values.size() > 1) continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    plan.columns.erase(plan.columns.begin() + at);
    for (SweepRun& run : plan.runs) run.values.erase(run.values.begin() + at);
  }
}

}  // namespace

SweepPlan plan_sweep(const SweepRequest& request, const std::string& program_sha256) {
  SweepPlan plan;
  const std::vector<Choice> choices = choices_of(request);
  const auto settings = combinations(choices);
  for (const Choice& choice : choices) plan.columns.push_back(choice.column);
  plan.logs = logs_of(request);
  if (settings.size() * plan.logs.size() > kMostRuns / request.seeds.count())
    throw UserError("a sweep has at most " + std::to_string(kMostRuns) +
                    " runs. Give fewer logs, values or seeds");
  for (std::size_t log = 0; log < plan.logs.size(); ++log) {
    for (const std::vector<std::string>& values : settings) {
      BoundSettings bound;
      set_up(bound, plan.logs[log], choices, values, request.threads);
      for (std::string& warning : bound.table.take_warnings())
        if (std::find(plan.warnings.begin(), plan.warnings.end(), warning) == plan.warnings.end())
          plan.warnings.push_back(std::move(warning));
      for (const std::uint64_t seed : request.seeds.all()) {
        bound.table.set("run.seed", std::to_string(seed), "--seeds");
        SweepRun run{log, values, seed, settings_file_text(bound.table), {}, {}};
        run.key = key_of(plan.logs[log], run.settings, program_sha256);
        run.folder = stem_of(plan.logs[log].log) + "-seed" + std::to_string(seed) + '-' +
                     run.key.substr(0, kFolderDigits);
        plan.runs.push_back(std::move(run));
      }
    }
  }
  require_all_different(plan);
  keep_what_varies(plan, choices);
  return plan;
}

}  // namespace psi_slam
