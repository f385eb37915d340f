// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <utility>

#include "base/partial_files.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr int kFileMode = 0666;  // the umask applies

}  // namespace

AtomicFile::AtomicFile(fs::path path)
    : path_(std::move(path)),
      temporary_path_(path_.parent_path() / new_partial_name(path_.filename().string())),
      descriptor_(
          ::open(temporary_path_.c_str(), O_CREAT | O_EXCL | O_NOFOLLOW | O_WRONLY | O_CLOEXEC, kFileMode)) {
  if (!descriptor_.is_open()) throw cannot_create(path_, errno);
}

AtomicFile::~AtomicFile() {
  if (!temporary_path_.empty()) ::unlink(temporary_path_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_.number(), bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw cannot_write(path_, count < 0 ? errno : ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

Descriptor AtomicFile::move_into_place() {
  wait_for_disk(descriptor_, path_);
  if (::rename(temporary_path_.c_str(), path_.c_str()) != 0) throw cannot_write(path_, errno);
  temporary_path_.clear();
  wait_for_disk(folder_of(path_), path_);
  return std::move(descriptor_);
}

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  AtomicFile file(path);
  write(file.temporary_path());
  file.move_into_place();
}

void write_text_atomically(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.move_into_place();
}

}  // namespace psi_slam
