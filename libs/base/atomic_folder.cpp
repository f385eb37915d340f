// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>
#include <utility>

#include "base/partial_files.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// A folder that the constructor creates and the destructor removes with its contents.
class ScopedFolder {
 public:
  ScopedFolder(fs::path path, const fs::path& parent) : path_(std::move(path)) {
    constexpr mode_t kFolderMode = 0700;
    if (::mkdir(path_.c_str(), kFolderMode) != 0) throw cannot_write(parent, errno);
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

/// Returns the text with each `from` replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Names of the entries of a folder, sorted.
std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

void move_files(const std::set<std::string>& names, const fs::path& from, const fs::path& to) {
  for (const std::string& name : names) wait_for_disk(from / name, to / name);
  for (const std::string& name : names) {
    std::error_code error;
    fs::rename(from / name, to / name, error);
    if (error) throw cannot_write(to / name, error.value());
  }
}

void remove_file(const fs::path& path) {
  if (::unlink(path.c_str()) != 0)
    throw SystemFailure("cannot delete " + path.string() + ": " + std::strerror(errno));
}

}  // namespace

void write_files_atomically(const fs::path& folder, const std::function<void(const fs::path&)>& write,
                            const std::function<bool(const std::string&)>& is_outdated) {
  const ScopedFolder temporary(folder / new_partial_name(), folder);
  try {
    write(temporary.path());
  } catch (const SystemFailure& failure) {
    throw SystemFailure(replaced(failure.what(), (temporary.path() / "").string(), (folder / "").string()));
  }
  const std::set<std::string> written = names_in(temporary.path());
  move_files(written, temporary.path(), folder);
  if (is_outdated)
    for (const std::string& name : names_in(folder))
      if (written.count(name) == 0 && !is_partial_name(name) && is_outdated(name)) remove_file(folder / name);
  wait_for_disk(folder_of(folder / "file"), folder);
}

}  // namespace psi_slam
