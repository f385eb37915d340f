// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {

/// Creates an empty folder in the system's folder for temporary files. Deletes it with its contents at the
/// end of the scope. Throws SystemFailure if it cannot be created.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "psi-slam-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw SystemFailure("cannot create the folder " + name + ": " + std::strerror(errno));
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace psi_slam
