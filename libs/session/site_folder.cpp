// SPDX-License-Identifier: BSD-3-Clause
#include "session/site_folder.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/file_bytes.h"
#include "base/number_text.h"
#include "localization/comparison/change_report.h"
#include "localization/reference_map.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kList = "site.json";
constexpr const char* kNewest = "newest";
constexpr const char* kSchema = "psi-slam site";
constexpr int kSchemaVersion = 1;
constexpr double kLeastChange_m = 0.5;  // shorter walls are not listed

Json point_json(const mrpt::math::TPoint2D& point) {
  return {point.x, point.y};
}

mrpt::math::TPoint2D point_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>()};
}

WallChange::Kind kind_of(const std::string& text) {
  for (const auto kind : {WallChange::Kind::kAppeared, WallChange::Kind::kVanished, WallChange::Kind::kMoved})
    if (text == name(kind)) return kind;
  throw Json::other_error::create(501, "unknown kind of change", nullptr);
}

Json to_json(const SiteRun& run) {
  Json changes = Json::array();
  for (const WallChange& change : run.changes)
    changes.push_back({{"kind", name(change.kind)},
                       {"from_m", point_json(change.from)},
                       {"to_m", point_json(change.to)},
                       {"length_m", change.length_m},
                       {"shift_m", point_json(change.shift)}});
  return {{"folder", run.folder},
          {"log", run.log},
          {"first_time_us", run.first_time_us},
          {"path_length_m", run.path_length_m},
          {"changes", std::move(changes)}};
}

SiteRun run_of(const Json& json) {
  SiteRun run;
  run.folder = json.at("folder").get<std::string>();
  run.log = json.at("log").get<std::string>();
  run.first_time_us = json.at("first_time_us").get<TimeUs>();
  run.path_length_m = json.at("path_length_m").get<double>();
  for (const Json& one : json.at("changes")) {
    WallChange change;
    change.kind = kind_of(one.at("kind").get<std::string>());
    change.from = point_of(one.at("from_m"));
    change.to = point_of(one.at("to_m"));
    change.length_m = one.at("length_m").get<double>();
    change.shift = point_of(one.at("shift_m"));
    run.changes.push_back(change);
  }
  return run;
}

std::vector<SiteRun> read_list(const fs::path& file) {
  try {
    const Json json = Json::parse(file_bytes(file));
    if (json.at("schema") != kSchema || json.at("schema_version") != kSchemaVersion)
      throw UserError(file.string() + " was written by another program or version, expected \"" + kSchema +
                      "\" of version " + std::to_string(kSchemaVersion) +
                      ". Use that version of psi-slam, or name another folder");
    std::vector<SiteRun> runs;
    for (const Json& run : json.at("runs")) runs.push_back(run_of(run));
    return runs;
  } catch (const Json::exception&) {
    throw UserError(file.string() +
                    " is damaged, expected the list of the runs of a site. Restore it, or name "
                    "another folder");
  } catch (const std::system_error& error) {
    throw UserError("cannot read " + file.string() + ": " + error.code().message() +
                    ". Check its permissions");
  }
}

/// Returns the number of the folder of a run; 0 for other names.
int number_of(const fs::path& folder) {
  const std::string name = folder.filename().string();
  const std::size_t digits = name.find_first_not_of("0123456789");
  const bool is_run = digits != std::string::npos && digits >= 4 && digits <= 9 && name[digits] == '-';
  return is_run ? std::stoi(name) : 0;
}

}  // namespace

SiteFolder::SiteFolder(fs::path path) : path_(std::move(path)) {
  std::error_code ignored;
  if (!fs::exists(path_, ignored)) return;
  if (!fs::is_directory(path_, ignored))
    throw UserError(path_.string() + " is a file, expected the folder of a site. Name another one");
  if (!fs::exists(path_ / kList, ignored)) {
    const auto is_foreign = [](const fs::directory_entry& entry) { return number_of(entry.path()) == 0; };
    if (std::none_of(fs::directory_iterator(path_), fs::directory_iterator(), is_foreign)) return;
    throw UserError(path_.string() + " is not empty and has no " + kList +
                    ", expected the folder of a site or a new one. Name another folder");
  }
  runs_ = read_list(path_ / kList);
  const auto exists = [&](const SiteRun& run) { return fs::is_directory(path_ / run.folder, ignored); };
  if (!runs_.empty() && std::none_of(runs_.begin(), runs_.end(), exists))
    throw UserError((path_ / kList).string() + " lists " + std::to_string(runs_.size()) +
                    " runs, but the folder of none of them exists. Restore the last one, or delete " + kList +
                    " to begin the site anew");
  for (const SiteRun& run : runs_) last_listed_ = std::max(last_listed_, number_of(run.folder));
  while (!runs_.empty() && !exists(runs_.back())) runs_.pop_back();
}

fs::path SiteFolder::map_of(const SiteRun& run) const {
  std::error_code ignored;
  for (const char* file : {"map.gridmap.gz", "map.yaml"})
    if (fs::exists(path_ / run.folder / file, ignored)) return path_ / run.folder / file;
  throw UserError((path_ / run.folder).string() +
                  ": this run of the site has no map, expected map.gridmap.gz or map.yaml. Map it with "
                  "map.write_mrpt=true, restore the file, or delete the folder to go back to the run before");
}

std::optional<fs::path> SiteFolder::newest_map() const {
  if (runs_.empty()) return std::nullopt;
  return map_of(runs_.back());
}

fs::path SiteFolder::folder_of_next(const std::string& name) const {
  // The numbers of deleted runs, and of runs that did not fit the site, are not used again.
  int last = last_listed_;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path_, ignored))
    last = std::max(last, number_of(entry.path()));
  char number[16];
  std::snprintf(number, sizeof number, "%04d-", last + 1);
  std::string folder = number + name;
  std::replace(folder.begin(), folder.end(), ' ', '-');  // "TCP port 5000"
  return path_ / folder;
}

const SiteRun& SiteFolder::add(SiteRun run) {
  const fs::path map = map_of(run);
  if (!runs_.empty()) {
    WallChangeOptions options;
    options.min_length_m = kLeastChange_m;
    run.changes =
        find_wall_changes(read_map_file(map_of(runs_.back())), read_map_file(map), {0, 0, 0}, options)
            .changes;
  }
  runs_.push_back(std::move(run));
  Json list = {{"schema", kSchema}, {"schema_version", kSchemaVersion}, {"runs", Json::array()}};
  for (const SiteRun& one : runs_) list["runs"].push_back(to_json(one));
  write_text_atomically(path_ / kList, list.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
  // A link is replaced whole by a new one that gets its name. Some file systems have no links.
  const fs::path link = path_ / kNewest;
  fs::path temporary = link;
  temporary += ".new";
  std::error_code ignored;
  fs::remove(temporary, ignored);
  fs::create_directory_symlink(runs_.back().folder, temporary, ignored);
  fs::rename(temporary, link, ignored);
  return runs_.back();
}

std::string changes_text(const std::vector<WallChange>& changes) {
  std::string text;
  const std::pair<WallChange::Kind, const char*> kKinds[] = {{WallChange::Kind::kAppeared, "new"},
                                                             {WallChange::Kind::kVanished, "gone"},
                                                             {WallChange::Kind::kMoved, "moved"}};
  for (const auto& [kind, word] : kKinds) {
    std::size_t count = 0;
    double length_m = 0;
    for (const WallChange& change : changes)
      if (change.kind == kind) ++count, length_m += change.length_m;
    if (count == 0) continue;
    text += (text.empty() ? "" : ", ") + std::to_string(count) + (count == 1 ? " wall is " : " walls are ") +
            word + " (" + fixed_text(length_m, 1) + " m)";
  }
  return text;
}

}  // namespace psi_slam
