// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_folder.h"

#include <signal.h>

#include <cerrno>
#include <chrono>
#include <set>
#include <system_error>
#include <vector>

#include "base/partial_name.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

void require(const std::error_code& error, const fs::path& path) {
  if (error) throw SystemFailure("cannot write " + path.string() + ": " + error.message());
}

bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

/// Numbers of processes are those of this machine: a folder may be shared with others.
bool is_old(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

/// A folder that is gone, with all in it, at the end of its scope.
class ScopedFolder {
 public:
  explicit ScopedFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::remove_all(path_, error);  // of a dead process with the same number
    fs::create_directory(path_, error);
    require(error, path_);
  }
  ~ScopedFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScopedFolder(const ScopedFolder&) = delete;
  ScopedFolder& operator=(const ScopedFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void write_files_atomically(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
  const ScopedFolder temporary(folder / partial_name());
  write(temporary.path());
  std::set<fs::path> files;
  for (const fs::directory_entry& file : fs::directory_iterator(temporary.path())) files.insert(file.path());
  for (const fs::path& file : files) {
    std::error_code error;
    fs::rename(file, folder / file.filename(), error);
    require(error, folder / file.filename());
  }
}

void remove_leftovers(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end && !ignored;
       entry.increment(ignored)) {
    const auto writer = writer_of(entry->path().filename().string());
    if (writer && has_ended(*writer) && is_old(entry->path())) leftovers.push_back(entry->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove_all(leftover, ignored);
}

}  // namespace psi_slam
