// SPDX-License-Identifier: BSD-3-Clause
#include "common/benchmark_logs.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/config/settings_text.h"
#include "batch/kept_run.h"
#include "map/exports/mapped_trajectory.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

std::vector<BenchmarkLog> logs_in_folder(const fs::path& data, const fs::path& ini) {
  if (!fs::is_directory(data)) throw UserError(data.string() + " is not a folder");
  std::map<std::string, fs::path> files;
  for (const auto& entry : fs::directory_iterator(data)) {
    const auto name = log_name_of(entry.path().filename().string());
    if (!name || !entry.is_regular_file()) continue;
    fs::path& file = files[*name];
    if (file.empty() || entry.path() < file) file = entry.path();
  }
  std::vector<BenchmarkLog> logs;
  for (const auto& [name, file] : files) {
    BenchmarkLog log{name, file, ini / (name + ".ini"), {}};
    if (!fs::exists(log.ini)) log.ini.clear();
    const fs::path relations = data / (name + ".relations");
    if (fs::exists(relations)) log.relations = relations;
    logs.push_back(std::move(log));
  }
  return logs;
}

std::vector<BenchmarkLog> find_benchmark_logs(const fs::path& data, const fs::path& ini) {
  std::vector<BenchmarkLog> logs = logs_in_folder(data, ini);
  if (logs.empty())
    throw UserError("there is no log in " + data.string() +
                    ": expected NAME.clf.gz, NAME.log or NAME.rawlog with NAME.relations beside it");
  return logs;
}

std::optional<fs::path> shipped_ini_folder() {
  std::error_code failed;
  fs::path folder = fs::read_symlink("/proc/self/exe", failed);
  while (!failed && folder.has_relative_path()) {
    folder = folder.parent_path();
    for (const fs::path& ini : {folder / "share" / "psi-slam" / "ini", folder / "ini"})
      if (fs::exists(ini / "aces.ini", failed)) return ini;
  }
  return std::nullopt;
}

Settings benchmark_settings(const fs::path& ini, const std::vector<std::string>& assignments,
                            std::vector<std::string>* warnings) {
  BoundSettings bound;
  bound.load(ini, {});
  if (warnings == nullptr) bound.table.take_warnings();
  for (const std::string& assignment : assignments) apply_override(assignment, bound.table, true);
  check(bound.settings);
  if (warnings != nullptr)
    for (std::string& warning : bound.table.take_warnings()) warnings->push_back(std::move(warning));
  else if (const std::vector<std::string> ignored = bound.table.take_warnings(); !ignored.empty())
    throw UserError(ignored.front());
  return bound.settings;
}

std::vector<std::string> paper_switch_settings() {
  return {"loop_closure.matcher=adaptive", "psi.psi_1=0.5", "psi.psi_2=1", "psi.max_poses=1e18"};
}

MappingResult map_source(FrameSource& source, const MapperOptions& options,
                         const std::function<void(double)>& progress) {
  Mapper mapper(options);
  while (std::optional<Frame> frame = source.next()) {
    mapper.add(std::move(*frame));
    progress(source.progress());
  }
  return mapper.finish();
}

std::size_t loops_accepted(const MappingResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(),
                    [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; }));
}

RelationsMetric error_of(const std::vector<FrameRecord>& frames, const std::vector<Relation>& relations) {
  return evaluate_relations(trajectory_of(frames), relations);
}

}  // namespace psi_slam
