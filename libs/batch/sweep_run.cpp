// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_run.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "batch/child_process.h"
#include "batch/kept_run.h"
#include "batch/workers.h"
#include "psi_slam/user_error.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kMostAttempts = 2;
constexpr const char* kResult = "run.json";
constexpr const char* kSummary = "summary.json";
constexpr const char* kSettings = "settings.ini";
constexpr const char* kPath = "trajectory.tum";
constexpr std::array<const char*, 5> kPathFiles{kPath, "trajectory.carmen", "graph.g2o", "frames.csv",
                                                "loops.csv"};

bool is_kept(const std::string& file, SweepKeep keep) {
  if (keep == SweepKeep::kMaps || file == kResult || file == kSummary || file == kSettings) return true;
  return keep == SweepKeep::kPaths &&
         std::find(kPathFiles.begin(), kPathFiles.end(), file) != kPathFiles.end();
}

Json figures_json(const SweepFigures& figures) {
  Json json = run_figures_json(figures);
  json["has_errors"] = figures.has_errors;
  SweepFigures::visit_map(figures, [&json](const char* key, const auto& value) { json[key] = value; });
  return json;
}

SweepFigures read_figures(const Json& json) {
  SweepFigures figures;
  static_cast<RunFigures&>(figures) = read_run_figures(json);
  json.at("has_errors").get_to(figures.has_errors);
  SweepFigures::visit_map(figures, [&json](const char* key, auto& value) { json.at(key).get_to(value); });
  return figures;
}

/// Figures in the files of a finished run; they hold no times. Throws when a file or figure is missing.
SweepFigures figures_of(const fs::path& folder, const fs::path& relations) {
  std::ifstream file(folder / kSummary);
  const Json summary = Json::parse(file);
  if (summary.at("interrupted").get<bool>()) throw SystemFailure("the run was interrupted");
  SweepFigures figures;
  if (!relations.empty()) {
    static_cast<RunFigures&>(figures) =
        evaluate_path(read_trajectory(folder / kPath), read_relations(relations));
    figures.has_errors = true;
  }
  summary.at("log").at("scans").get_to(figures.scans);
  summary.at("log").at("duration_s").get_to(figures.duration_s);
  summary.at("nodes").get_to(figures.nodes);
  summary.at("path_length_m").get_to(figures.path_length_m);
  const Json& loops = summary.at("loop_counts");
  loops.at("accepted").get_to(figures.loops_accepted);
  loops.at("refused").get_to(figures.loops_refused);
  loops.at("switched_off").get_to(figures.loops_switched_off);
  return figures;
}

void leave_only(const fs::path& folder, SweepKeep keep) {
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(folder))
    if (!is_kept(entry.path().filename().string(), keep)) others.push_back(entry.path());
  for (const fs::path& other : others) fs::remove_all(other);
}

struct Attempt {
  SweepOutcome outcome;
  bool once_more = false;  ///< another attempt may succeed
  bool stopped = false;
};

/// Runs psi-slam once, with its results in `folder`.
Attempt attempt(const SweepOrder& order, const fs::path& folder, const std::function<bool()>& stop) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  write_text_atomically(folder / kSettings, order.settings);
  ChildProcess child;
  // An absolute path cannot be mistaken for an option or a command.
  child.words = {order.program.string(),
                 "-c",
                 (folder / kSettings).string(),
                 "-o",
                 folder.string(),
                 "--force",
                 "--quiet",
                 fs::absolute(order.log).string()};
  child.stop = stop;
  const ChildEnd end = run_child(child);
  Attempt made;
  made.stopped = end.stopped;
  made.outcome.failure = end.failure_without("psi-slam: ");
  // Wrong input fails again.
  made.once_more = !made.outcome.failure.empty() && end.code != kExitWrongUsageOrInput;
  if (!made.outcome.failure.empty()) return made;
  try {
    SweepFigures figures = figures_of(folder, order.relations);
    set_effort(figures, end);
    made.outcome.figures = figures;
  } catch (const SystemFailure& failure) {
    made.outcome.failure = failure.what();
    made.once_more = true;
  }
  return made;
}

/// Replaces the folder of the order with the finished result.
void put_in_place(const SweepOrder& order, const fs::path& made, const SweepOutcome& outcome) {
  leave_only(made, order.keep);
  keep_run(made / kResult, {order.key},
           {{"schema", "psi-slam-sweep-run"},
            {"schema_version", 1},
            {"log", order.log.string()},
            {"figures", figures_json(*outcome.figures)}});
  fs::remove_all(order.folder);
  fs::rename(made, order.folder);
}

std::optional<SweepOutcome> make_or_throw(const SweepOrder& order, const fs::path& folder,
                                          const std::function<bool()>& stop) {
  Attempt made;
  for (int attempts = 1; attempts <= kMostAttempts; ++attempts) {
    made = attempt(order, folder, stop);
    made.outcome.attempts = attempts;
    if (made.stopped) return std::nullopt;
    if (!made.once_more) break;
  }
  if (made.outcome.figures) put_in_place(order, folder, made.outcome);
  return made.outcome;
}

}  // namespace

std::optional<SweepOutcome> kept_outcome(const SweepOrder& order) {
  const std::optional<Json> kept = kept_run(order.folder / kResult, {order.key});
  if (!kept) return std::nullopt;
  if (order.keep >= SweepKeep::kPaths)
    for (const char* file : kPathFiles)
      if (!fs::exists(order.folder / file)) return std::nullopt;
  if (order.keep == SweepKeep::kMaps && !fs::exists(order.folder / "map.png")) return std::nullopt;
  try {
    return SweepOutcome{read_figures(kept->at("figures")), {}, 0};
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::optional<SweepOutcome> make_run(const SweepOrder& order, const std::function<bool()>& stop) {
  fs::path folder = order.folder;
  folder += ".part";
  std::optional<SweepOutcome> outcome;
  try {
    outcome = make_or_throw(order, folder, stop);
  } catch (const std::exception& error) {
    outcome = SweepOutcome{{}, error.what(), 1};
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return outcome;
}

std::string order_text(const SweepOrder& order) {
  return cbor_text({order.program.string(), order.log.string(), order.relations.string(), order.settings,
                    order.key, order.folder.string(), static_cast<int>(order.keep)});
}

SweepOrder read_order(const std::string& text) {
  const Json json = Json::from_cbor(text);
  const auto word = [&](std::size_t index) { return json.at(index).get<std::string>(); };
  constexpr std::size_t kKeep = 6;
  return {word(0),
          word(1),
          word(2),
          word(3),
          word(4),
          word(5),
          static_cast<SweepKeep>(json.at(kKeep).get<int>())};
}

std::string outcome_text(const SweepOutcome& outcome) {
  return Json{{"figures", outcome.figures ? figures_json(*outcome.figures) : Json(nullptr)},
              {"failure", outcome.failure},
              {"attempts", outcome.attempts}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

SweepOutcome read_outcome(const std::string& text) {
  const Json json = Json::parse(text);
  SweepOutcome outcome;
  if (!json.at("figures").is_null()) outcome.figures = read_figures(json.at("figures"));
  json.at("failure").get_to(outcome.failure);
  json.at("attempts").get_to(outcome.attempts);
  return outcome;
}

}  // namespace psi_slam
