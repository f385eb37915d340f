// SPDX-License-Identifier: BSD-3-Clause
// Fake baselines that tests install in a folder: shell scripts in bin/, settings in share/.
#pragma once

#include <filesystem>
#include <string>

#include "freiburg/baselines.h"
#include "test_files.h"

namespace psi_slam {

/// Installs settings and a program that prints a version. With two arguments, a settings file ($1) and a log
/// ($2), the program also runs `script`, in which $output is the output folder.
inline void install_baseline(const std::filesystem::path& prefix, const BaselineKind& kind,
                             const std::string& script) {
  namespace fs = std::filesystem;
  const fs::path program = prefix / "bin" / kind.name;
  const fs::path config = prefix / "share/mrpt/config_files" / kind.config;
  fs::create_directories(program.parent_path());
  fs::create_directories(config.parent_path());
  write_file(program,
             "#!/bin/sh\n"
             "PATH=/usr/bin:/bin\n"
             "echo ' MRPT C++ Library: MRPT 9.9.9 - Sources'\n"
             "[ $# -eq 2 ] || exit 1\n"
             "output=$(sed -n 's/^logOutput_dir *= *//p' \"$1\")\n"
             "mkdir -p \"$output\"\n" +
                 script + '\n');
  fs::permissions(program, fs::perms::owner_all);
  write_file(config,
             "[MappingApplication]\nlogOutput_dir = LOG // a remark\nSAVE_3D_SCENE = 1\n[ICP]\nALFA = 0.8\n");
}

/// Script that writes one pose per scan: the scan's index and `columns`, which are x, y and heading.
inline std::string standing_still(std::size_t scans, const std::string& columns = "0 0 0") {
  return "i=0; while [ $i -lt " + std::to_string(scans) + " ]; do echo \"$i " + columns +
         "\"; i=$((i+1)); done > \"$output/log_estimated_path.txt\"";
}

inline FoundBaselines baselines_in(const std::filesystem::path& prefix) {
  return find_baselines((prefix / "bin").string());
}

}  // namespace psi_slam
