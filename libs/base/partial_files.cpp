// SPDX-License-Identifier: BSD-3-Clause
#include "base/partial_files.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>
#include <random>
#include <system_error>
#include <vector>

#include "base/text_parts.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartial = ".partial-";
constexpr std::size_t kMostNameBytes = 200;  // file systems allow 255 bytes for a whole name

/// Process id in the name of a temporary file or folder. Empty for other names.
std::optional<pid_t> writer_of(std::string_view name) {
  if (!starts_with(name, kPartial)) return std::nullopt;
  name.remove_prefix(kPartial.size());
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  const bool whole = end == name.data() + name.size() || *end == '-';
  return error == std::errc() && whole && pid > 0 ? std::optional(pid) : std::nullopt;
}

bool has_ended(pid_t process) {
  return ::kill(process, 0) != 0 && errno == ESRCH;
}

/// Returns whether a leftover is older than an hour. Younger leftovers are kept: a process on another machine
/// that shares the folder may still write them.
bool is_old(const fs::path& path) {
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written > std::chrono::hours(1);
}

}  // namespace

std::string new_partial_name(const std::string& name) {
  std::random_device random;
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%08x%08x", random(), random());
  const std::string partial = std::string(kPartial) + std::to_string(::getpid()) + '-' + digits.data();
  if (name.empty()) return partial;
  return partial + '-' + name.substr(name.size() - std::min(name.size(), kMostNameBytes));
}

bool is_partial_name(std::string_view name) {
  return writer_of(name).has_value();
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

SystemFailure cannot_write(const fs::path& path, int error_number) {
  return SystemFailure("cannot write " + path.string() + ": " + std::strerror(error_number));
}

SystemFailure cannot_create(const fs::path& path, int error_number) {
  const SystemFailure failure = cannot_write(path, error_number);
  const bool is_of_folder =
      error_number == ENOENT || error_number == ENOTDIR || error_number == EACCES || error_number == EROFS;
  if (!is_of_folder) return failure;
  return SystemFailure(std::string(failure.what()) + ". Choose a folder that exists and is writable");
}

void wait_for_disk(const Descriptor& written, const fs::path& path) {
  // Some file systems, such as those of the kernel, cannot wait.
  if (::fsync(written.number()) != 0 && errno != EINVAL && errno != EROFS) throw cannot_write(path, errno);
}

void wait_for_disk(const fs::path& written, const fs::path& path) {
  const Descriptor descriptor(::open(written.c_str(), O_RDONLY | O_CLOEXEC));
  if (!descriptor.is_open() && errno == EACCES) return;  // a folder may be writable but not readable
  if (!descriptor.is_open()) throw cannot_write(path, errno);
  wait_for_disk(descriptor, path);
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
