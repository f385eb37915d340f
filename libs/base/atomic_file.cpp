// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "base/descriptor.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartial = ".partial-";

// The name ".partial-PID" with the id of this process. Temporary folders have this name; names of temporary
// files begin with it.
std::string partial_name() {
  return std::string(kPartial) + std::to_string(::getpid());
}

// Process id in the name of a temporary file or folder. Empty for other names.
std::optional<pid_t> writer_of(std::string_view name) {
  if (!starts_with(name, kPartial)) return std::nullopt;
  name.remove_prefix(kPartial.size());
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  const bool whole = end == name.data() + name.size() || *end == '-';
  return error == std::errc() && whole && pid > 0 ? std::optional(pid) : std::nullopt;
}

SystemFailure cannot_write(const fs::path& path, const std::string& why) {
  return SystemFailure("cannot write " + path.string() + ": " + why);
}

void require(const std::error_code& error, const fs::path& path) {
  if (error) throw cannot_write(path, error.message());
}

bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

// Returns whether a leftover is older than an hour. Younger leftovers are kept: a process on another machine
// that shares the folder may still write them.
bool is_old(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

// Waits until the disk holds a file or the entries of a folder, so that a power failure cannot undo what was
// reported as written. `path` is named in the exception.
void wait_for_disk(const fs::path& written, const fs::path& path) {
  const Descriptor descriptor(::open(written.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.is_open()) return;  // the folder may be writable but not readable
  if (::fsync(descriptor.number()) != 0 && errno != EINVAL && errno != EROFS)
    throw cannot_write(path, std::strerror(errno));
}

// The folder that holds the entry of a file.
fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// A folder that the constructor creates and the destructor removes with its contents.
class ScopedFolder {
 public:
  explicit ScopedFolder(fs::path path) : path_(std::move(path)) {
    std::error_code error;
    fs::remove_all(path_, error);  // an ended process with the same id may have left it
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

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = path.parent_path() / (partial_name() + '-' + path.filename().string());
  std::error_code error;
  try {
    write(temporary);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  if (!fs::exists(temporary, error))
    throw cannot_write(
        path, "its folder is missing, read-only or full. Choose a folder that exists and is writable");
  try {
    wait_for_disk(temporary, path);
    fs::rename(temporary, path, error);
    if (error) throw cannot_write(path, error.message());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  wait_for_disk(folder_of(path), path);
}

void write_text_atomically(const fs::path& path, std::string_view text) {
  write_atomically(path, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) throw cannot_write(path, errno != 0 ? std::strerror(errno) : "the disk may be full");
  });
}

void write_files_atomically(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
  const ScopedFolder temporary(folder / partial_name());
  write(temporary.path());
  std::set<fs::path> files;
  for (const fs::directory_entry& file : fs::directory_iterator(temporary.path())) files.insert(file.path());
  for (const fs::path& file : files) wait_for_disk(file, folder / file.filename());
  for (const fs::path& file : files) {
    std::error_code error;
    fs::rename(file, folder / file.filename(), error);
    require(error, folder / file.filename());
  }
  wait_for_disk(folder, folder);
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
