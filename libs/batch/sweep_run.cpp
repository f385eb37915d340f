// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_run.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "batch/child_process.h"
#include "batch/kept_run.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/user_error.h"

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

/// Reads the figures of a finished run from its files. Wall time, processor time and memory stay 0. Throws if
/// a file or figure is missing.
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
  loops.at("rejected").get_to(figures.loops_rejected);
  return figures;
}

void leave_only(const fs::path& folder, SweepKeep keep) {
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(folder))
    if (!is_kept(entry.path().filename().string(), keep)) others.push_back(entry.path());
  for (const fs::path& other : others) fs::remove_all(other);
}

/// Runs psi-slam once, with its results in `folder`.
ChildEnd run_psi_slam(const SweepOrder& order, const fs::path& folder, const std::function<bool()>& stop) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string settings = (folder / kSettings).string();
  write_text_atomically(settings, order.settings);
  // An absolute path cannot be mistaken for an option or a command.
  const std::string log = fs::absolute(order.log).string();
  const ChildWords words{order.program.string(), "-c",      settings,  "-o",
                         folder.string(),        "--force", "--quiet", log};
  return run_child({words, 0, stop});
}

SweepOutcome outcome_of(const ChildEnd& end, const SweepOrder& order, const fs::path& folder) {
  SweepOutcome outcome{{}, end.failure_without("psi-slam: "), 0};
  if (!outcome.failure.empty()) return outcome;
  try {
    SweepFigures figures = figures_of(folder, order.relations);
    set_effort(figures, end);
    outcome.figures = figures;
  } catch (const SystemFailure& failure) {
    outcome.failure = failure.what();
  }
  return outcome;
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
  SweepOutcome outcome;
  for (int attempts = 1; attempts <= kMostAttempts; ++attempts) {
    const ChildEnd end = run_psi_slam(order, folder, stop);
    if (end.stopped) return std::nullopt;
    outcome = outcome_of(end, order, folder);
    outcome.attempts = attempts;
    if (outcome.figures || end.code == kExitWrongUsageOrInput) break;  // wrong input fails again
  }
  if (outcome.figures) put_in_place(order, folder, outcome);
  return outcome;
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

}  // namespace psi_slam
