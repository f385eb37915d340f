// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "base/partial_name.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

SystemFailure cannot_write(const fs::path& path, const std::string& why) {
  return SystemFailure("cannot write " + path.string() + ": " + why);
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
  const fs::path temporary = path.parent_path() / partial_name(path.filename().string());
  std::error_code error;
  try {
    write(temporary);
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  if (!fs::exists(temporary, error)) throw cannot_write(path, "its folder is missing, read-only or full");
  fs::rename(temporary, path, error);
  if (error) {
    const std::string why = error.message();
    fs::remove(temporary, error);
    throw cannot_write(path, why);
  }
}

void write_text_atomically(const fs::path& path, std::string_view text) {
  write_atomically(path, [&](const fs::path& temporary) {
    errno = 0;
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) throw cannot_write(path, errno != 0 ? std::strerror(errno) : "the disk did not take it");
  });
}

}  // namespace psi_slam
