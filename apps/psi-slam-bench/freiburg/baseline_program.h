// SPDX-License-Identifier: BSD-3-Clause
// Mappers of others that may be installed here and run on our logs: MRPT's icp-slam and rbpf-slam.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace psi_slam {

/// Properties of a mapper, installed or not.
struct BaselineKind {
  std::string name;    ///< of the program: "icp-slam"
  std::string config;  ///< the shipped settings, relative to share/mrpt/config_files
  /// Changed settings of the section MappingApplication: no windows, no pictures, a fixed random seed.
  std::vector<std::pair<std::string, std::string>> changes;
  std::string remark;          ///< a sentence on its figures; may be empty
  std::size_t yaw_column = 3;  ///< in the file of its path, whose first columns are step, x and y
};
const std::vector<BaselineKind>& baseline_kinds();

struct BaselineProgram {
  BaselineKind kind;
  std::filesystem::path program;
  std::filesystem::path config;
  std::string version;  ///< as the program prints it: "MRPT 2.5.8 - Sources timestamp: ..."
  std::string sha256;   ///< of the program file
};

struct FoundBaselines {
  std::vector<BaselineProgram> programs;
  std::vector<std::string> missing;  ///< a sentence with the reason for each program that cannot be run
};

/// Searches the folders of `search_path`, separated by colons as in PATH, and the settings in share/ beside
/// the bin/ of each program.
FoundBaselines find_baselines(const std::string& search_path);

/// The shipped settings with the changes of the kind and the folder for the program's output. Throws
/// UserError when the shipped settings cannot be read.
std::string baseline_settings(const BaselineProgram& baseline, const std::filesystem::path& output);

/// The changes of the settings as text: "SAVE_3D_SCENE = 0, RANDOM_SEED = 1".
std::string changes_text(const BaselineKind& kind);

}  // namespace psi_slam
