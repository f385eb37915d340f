// SPDX-License-Identifier: BSD-3-Clause
#include "files_to_write.h"

#include <filesystem>
#include <string>
#include <vector>

#include "base/partial_files.h"
#include "batch/kept_run.h"
#include "map/report/output_folder.h"
#include "psi_slam/user_error.h"
#include "session/session_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// A file that the arguments name.
struct NamedFile {
  std::string what;  ///< "the log" or the option
  fs::path path;
};

/// Returns the files to read, except the session of --resume, which a new session may replace.
std::vector<NamedFile> files_to_read(const CommandLine& line) {
  std::vector<NamedFile> files{{"the log", line.log},
                               {"the settings file", line.config},
                               {"the file of edits", line.edits},
                               {"the log", line.live.follow},
                               {"the settings file", line.live.sensors}};
  for (const std::string& input : line.inputs) files.push_back({"the input", input});
  return files;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return !a.empty() && !b.empty() && fs::equivalent(a, b, ignored);
}

/// Returns whether the results in `folder` have or replace a file of this path.
bool is_result_in(const fs::path& folder, const fs::path& file) {
  return !file.empty() && OutputFolder::is_result(file.filename().string()) &&
         is_same_file(folder_of(file), folder);
}

void check_file_to_write(const NamedFile& file, const std::string& if_exists, const CommandLine& line) {
  if (file.path.empty()) return;
  const std::string where = file.what + ' ' + file.path.string() + ": ";
  std::error_code ignored;
  if (fs::is_directory(file.path, ignored)) throw UserError(where + "is a folder, expected a file");
  if (!fs::is_directory(folder_of(file.path), ignored))
    throw UserError(where + "the folder " + folder_of(file.path).string() +
                    " does not exist: create it first");
  const bool exists = fs::exists(file.path, ignored);
  if (exists && !fs::is_regular_file(file.path, ignored))
    throw UserError(where + "is a device or a pipe, expected a file");
  for (const NamedFile& input : files_to_read(line)) {
    const auto grows = [&] { return file.path == line.save_session && is_session_file(input.path); };
    if (is_same_file(input.path, file.path) && !grows())  // a session that grows was read whole before
      throw UserError(where + "this is " + input.what + ", which would be lost. Name another file");
    if (exists && is_same_file(input.path, folder_of(file.path)))
      throw UserError(where + "this is a file of " + input.what + ' ' + input.path.string() +
                      ", which would be lost. Name another file");
  }
  if (is_result_in(line.output, file.path))
    throw UserError(where + "the results in " + line.output + " have a file of this name. Name another file");
  if (exists && !line.force && !is_same_file(file.path, line.resume))
    throw UserError(where + "the file exists. " + if_exists);
}

}  // namespace

void check_files_to_write(const CommandLine& line) {
  check_file_to_write({"--save-session", line.save_session}, "Replace it with --force", line);
  check_file_to_write({"--record", line.live.record}, "Replace it with --force, or name another file", line);
  check_file_to_write({"--journal", line.journal},
                      "Resume it with psi-slam --resume " + line.journal + ", or replace it with --force",
                      line);
  for (const NamedFile& input : files_to_read(line))
    if (input.path != line.edits && is_result_in(line.output, input.path))
      throw UserError("the results in " + line.output + " would replace " + input.what + ' ' +
                      input.path.string() + ". Name another output folder");
}

std::string run_name(const CommandLine& line) {
  const fs::path input = fs::absolute(line.log.empty() ? line.resume : line.log).lexically_normal();
  const fs::path file = input.has_filename() ? input.filename() : input.parent_path().filename();
  return log_name_of(file.string()).value_or(file.stem().string());
}

fs::path default_output_folder(const CommandLine& line) {
  const std::string name = run_name(line) + "-map";
  std::error_code ignored;
  fs::path folder = name;
  for (int number = 2; !line.force && fs::exists(folder, ignored); ++number)
    folder = name + '-' + std::to_string(number);
  return folder;
}

}  // namespace psi_slam
