// SPDX-License-Identifier: BSD-3-Clause
#include "other_programs.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// Replaces this process by `file`, or by a program of this name in PATH if it has no folder. Returns only if
/// that fails, with errno set.
void execute(const std::string& file, const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execvp(file.c_str(), pointers.data());
}

}  // namespace

const std::vector<OtherProgram>& other_programs() {
  static const std::vector<OtherProgram> programs{
      {"bench", "psi-slam-bench", "psi-slam-bench",
       "Measure accuracy and speed on benchmark logs and in simulations"},
      {"gui", "psi-slam-gui", "psi-slam", "Open the window, which replays logs and edits maps"},
      {"graphslam", "psi-graphslam", "psi-slam",
       "Map a rawlog with the deciders and optimisers of MRPT's graph SLAM"},
  };
  return programs;
}

const OtherProgram* other_program(std::string_view command) {
  const auto& programs = other_programs();
  const auto found = std::find_if(programs.begin(), programs.end(),
                                  [&](const OtherProgram& other) { return other.command == command; });
  return found == programs.end() ? nullptr : &*found;
}

void become(const OtherProgram& other, const std::vector<std::string>& arguments) {
  std::error_code ignored;
  const fs::path own_file = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path folder = own_file.parent_path();
  const std::string own_name = own_file.filename().string();
  const std::string program = other.program;
  // Installed programs share a folder; in the build tree, each has its own.
  for (const fs::path& file : {folder / program, folder.parent_path() / program / program})
    if (fs::is_regular_file(file, ignored)) {
      execute(file.string(), program, arguments);
      throw SystemFailure("cannot start " + file.string() + ": " + std::strerror(errno));
    }
  execute(program, program, arguments);
  if (errno == ENOENT)
    throw UserError(std::string("psi-slam ") + other.command + " runs " + program +
                    ", which is neither beside " + own_name + " nor in PATH. Debian's package " +
                    other.package + " contains it");
  throw SystemFailure("cannot start " + program + ": " + std::strerror(errno));
}

}  // namespace psi_slam
