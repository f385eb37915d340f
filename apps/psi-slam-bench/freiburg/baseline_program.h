// SPDX-License-Identifier: BSD-3-Clause
// Mappers of others that are installed here and can be run on our logs: MRPT's own icp-slam and rbpf-slam.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace psi_slam {

/// What is known of a mapper, installed or not.
struct BaselineKind {
  std::string name;    ///< of the program: "icp-slam"
  std::string config;  ///< the settings it ships with, below share/mrpt/config_files
  /// What is set otherwise of its section MappingApplication: no windows, no pictures, no chance.
  std::vector<std::pair<std::string, std::string>> changes;
  std::string remark;          ///< a sentence on its figures; may be empty
  std::size_t yaw_column = 3;  ///< of its path's file, whose first columns are step, x and y
};
const std::vector<BaselineKind>& baseline_kinds();

struct BaselineProgram {
  BaselineKind kind;
  std::filesystem::path program;
  std::filesystem::path config;
  std::string version;  ///< "MRPT 2.5.8 - Sources timestamp: ...", as it tells it
  std::string sha256;   ///< of the program's file
};

struct FoundBaselines {
  std::vector<BaselineProgram> programs;
  std::vector<std::string> missing;  ///< a sentence for each that cannot be run, and why
};

/// Looks in the folders of `search_path`, colons in between, as a shell does; the settings are looked for in
/// share/ beside the program's bin/.
FoundBaselines find_baselines(const std::string& search_path);

/// The shipped settings with what is set otherwise, and the folder for what the program writes. Throws
/// UserError when they cannot be read.
std::string baseline_settings(const BaselineProgram& baseline, const std::filesystem::path& output);

/// What is set otherwise, for people: "SAVE_3D_SCENE = 0, RANDOM_SEED = 1".
std::string changes_text(const BaselineKind& kind);

}  // namespace psi_slam
