// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baseline_program.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "base/file_checksum.h"
#include "batch/child_process.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSection = "MappingApplication";
constexpr double kVersionLimit_s = 30;

std::optional<fs::path> find_program(const std::string& name, const std::string& search_path) {
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    std::error_code failed;
    if (fs::is_regular_file(program, failed) && ::access(program.c_str(), X_OK) == 0)
      return fs::canonical(program);
  }
  return std::nullopt;
}

/// Version in the program's first output; there is no option for it.
std::string version_of(const fs::path& program) {
  constexpr std::string_view kBefore = "MRPT C++ Library: ";
  ChildProcess child;
  child.words = {program.string()};
  child.time_limit_s = kVersionLimit_s;
  const ChildEnd end = run_child(child);
  const std::string words = end.out + end.err;
  const std::size_t begin = words.find(kBefore);
  if (begin == std::string::npos) return "unknown version";
  const std::size_t first = begin + kBefore.size();
  return words.substr(first, words.find_first_of("\r\n", first) - first);
}

}  // namespace

const std::vector<BaselineKind>& baseline_kinds() {
  constexpr std::size_t kPlaneYaw = 3;
  constexpr std::size_t kSpaceYaw = 4;  // after z
  static const std::vector<BaselineKind> kKinds{
      {"icp-slam",
       "icp-slam/icp-slam_demo_classic.ini",
       {{"SHOW_PROGRESS_3D_REAL_TIME", "0"}, {"SAVE_3D_SCENE", "0"}},
       "Tiny changes of the input decide where it loses track, so other runs give other figures. Started "
       "one, two or three scans later, it reaches 0.68, 0.42 and 1.96 m on MIT CSAIL.",
       kPlaneYaw},
      {"rbpf-slam",
       "rbpf-slam/gridmapping_RBPF_grid_ICPbased_malaga.ini",
       {{"SHOW_PROGRESS_IN_WINDOW", "0"},
        {"SAVE_3D_SCENE", "0"},
        {"SAVE_MAP_IMAGES", "0"},
        {"RANDOM_SEED", "1"}},
       "Its path consists of its estimates at the time of each scan. It is not the path of the best "
       "particle.",
       kSpaceYaw}};
  return kKinds;
}

FoundBaselines find_baselines(const std::string& search_path) {
  FoundBaselines found;
  for (const BaselineKind& kind : baseline_kinds()) {
    const auto program = find_program(kind.name, search_path);
    if (!program) {
      found.missing.push_back(kind.name + " is not on PATH");
      continue;
    }
    const fs::path config = program->parent_path().parent_path() / "share/mrpt/config_files" / kind.config;
    if (!fs::exists(config)) {
      found.missing.push_back(program->string() + " has no settings: expected " + config.string());
      continue;
    }
    found.programs.push_back({kind, *program, config, version_of(*program), sha256_of_file(*program)});
  }
  return found;
}

std::string baseline_settings(const BaselineProgram& baseline, const fs::path& output) {
  std::ifstream file(baseline.config, std::ios::binary);
  const std::string shipped(std::istreambuf_iterator<char>(file), {});
  if (!file) throw UserError(baseline.config.string() + " cannot be read");
  mrpt::config::CConfigFileMemory settings(shipped);
  for (const auto& [key, value] : baseline.kind.changes) settings.write(kSection, key, value);
  settings.write(kSection, "logOutput_dir", output.string());
  return settings.getContent();
}

std::string changes_text(const BaselineKind& kind) {
  std::string text;
  for (const auto& [key, value] : kind.changes) text += (text.empty() ? "" : ", ") + key + " = " + value;
  return text;
}

}  // namespace psi_slam
