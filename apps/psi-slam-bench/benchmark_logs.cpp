// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark_logs.h"

#include <algorithm>
#include <map>
#include <utility>

#include "mapped_run.h"
#include "psi_slam/user_error.h"
#include "batch/log_name.h"
#include "config/apply_settings.h"
#include "config/ini_file.h"
#include "psi_slam/open_log.h"
#include "evaluation/relations_metric.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// The front end once more beside the mapper, which keeps its local maps to itself: it gives the same ones.
class PlaceCollector {
 public:
  explicit PlaceCollector(const FrontEndOptions& options) : front_end_(options) {}

  void add(const Frame& frame) {
    const FrontEndStep step = front_end_.add(frame);
    if (step.node) remember_node(step, frames_, memory_);
    keep(step.finished);
    ++frames_;
  }

  KeyframeStore finish() {
    keep(front_end_.finish());
    return std::move(memory_);
  }

 private:
  void keep(const std::vector<PlacedLocalMap>& finished) {
    for (const PlacedLocalMap& local_map : finished) remember_local_map(local_map, memory_);
  }

  FrontEnd front_end_;
  KeyframeStore memory_;
  std::size_t frames_ = 0;
};

/// By node: the matcher that Psi chose there when the log was mapped.
std::vector<std::string> adaptive_matchers(const MappingResult& result) {
  std::vector<std::string> names;
  for (const std::size_t frame : result.node_frames) names.emplace_back(name(result.frames[frame].matcher.value()));
  return names;
}

}  // namespace

std::vector<BenchmarkLog> find_benchmark_logs(const fs::path& data, const fs::path& ini) {
  if (!fs::is_directory(data)) throw UserError(data.string() + " is no folder");
  std::map<std::string, fs::path> files;
  for (const auto& entry : fs::directory_iterator(data)) {
    const auto name = log_name_of(entry.path().filename().string());
    if (!name || !entry.is_regular_file()) continue;
    fs::path& file = files[*name];
    if (file.empty() || entry.path() < file) file = entry.path();
  }
  if (files.empty())
    throw UserError("there is no log in " + data.string() +
                    ": expected NAME.clf.gz, NAME.log or NAME.rawlog with NAME.relations beside it");
  std::vector<BenchmarkLog> logs;
  for (const auto& [name, file] : files) {
    BenchmarkLog log{name, file, ini / (name + ".ini"), {}};
    if (!fs::exists(log.ini))
      throw UserError(file.string() + " has no settings: expected " + log.ini.string() +
                      " with the facts of its sensor");
    const fs::path relations = data / (name + ".relations");
    if (fs::exists(relations)) log.relations = relations;
    logs.push_back(std::move(log));
  }
  return logs;
}

std::optional<fs::path> shipped_ini_folder() {
  std::error_code failed;
  fs::path folder = fs::read_symlink("/proc/self/exe", failed).parent_path();
  while (!failed && !folder.empty()) {
    for (const fs::path& ini : {folder / "share" / "psi-slam" / "ini", folder / "ini"})
      if (fs::exists(ini / "psi-slam.ini", failed)) return ini;
    if (folder == folder.root_path()) break;
    folder = folder.parent_path();
  }
  return std::nullopt;
}

Settings benchmark_settings(const fs::path& ini, const std::vector<std::string>& assignments) {
  Settings settings;
  OptionTable table;
  describe(table, settings);
  apply(read_ini(ini), table);
  for (const std::string& assignment : assignments) apply_override(assignment, table);
  check(settings);
  return settings;
}

MappedLog map_log(const BenchmarkLog& log, std::size_t nodes_per_local_map,
                  const std::function<void(double)>& progress) {
  const Settings settings = benchmark_settings(log.ini);
  MappedLog mapped;
  mapped.name = log.name;
  mapped.options = settings.mapper;
  FrontEndOptions& front_end = mapped.options.front_end;
  front_end.local_map_travel_m *=
      static_cast<double>(nodes_per_local_map) / static_cast<double>(front_end.nodes_per_local_map);
  front_end.nodes_per_local_map = nodes_per_local_map;

  const std::unique_ptr<FrameSource> source = open_log(log.log, log_options(settings));
  Mapper mapper(mapped.options);
  PlaceCollector places(front_end);
  while (std::optional<Frame> frame = source->next()) {
    places.add(*frame);
    mapper.add(std::move(*frame));
    progress(source->progress());
  }
  mapped.memory = places.finish();
  const MappingResult result = mapper.finish();
  mapped.map_T_node = result.graph.poses();
  mapped.adaptive_matcher = adaptive_matchers(result);
  mapped.translation_error_m =
      error_of(result.frames, read_relations(log.relations.value())).translation_abs_m.mean;
  return mapped;
}

}  // namespace psi_slam
