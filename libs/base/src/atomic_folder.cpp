// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/base/atomic_folder.h"

#include <unistd.h>

#include <set>
#include <string>
#include <system_error>

#include "psi_slam/base/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

void require(const std::error_code& error, const fs::path& path) {
  if (error) throw SystemFailure("cannot write " + path.string() + ": " + error.message());
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
  const ScopedFolder temporary(folder / (".partial-" + std::to_string(::getpid())));
  write(temporary.path());
  std::set<fs::path> files;
  for (const fs::directory_entry& file : fs::directory_iterator(temporary.path())) files.insert(file.path());
  for (const fs::path& file : files) {
    std::error_code error;
    fs::rename(file, folder / file.filename(), error);
    require(error, folder / file.filename());
  }
}

}  // namespace psi_slam
