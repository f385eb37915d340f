// SPDX-License-Identifier: BSD-3-Clause
#include "bench_command.h"

#include <unistd.h>

#include "benchmark_logs.h"
#include "psi_slam/base/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

void check_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file)) throw UserError(file.string() + " is a folder: name a file");
  if (!fs::is_directory(folder)) throw UserError("the folder of " + file.string() + " does not exist");
  if (::access(folder.c_str(), W_OK) != 0) throw UserError(file.string() + " cannot be written");
}

void prepare_folder(const fs::path& folder, const std::string& file) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    throw UserError("the folder " + folder.string() + " cannot be made: " + failed.message());
  check_writable(folder / file);
}

fs::path ini_folder(const std::string& given) {
  if (!given.empty()) return given;
  if (const auto shipped = shipped_ini_folder()) return *shipped;
  throw UserError("name the folder of the logs' settings: --ini DIR");
}

}  // namespace psi_slam
