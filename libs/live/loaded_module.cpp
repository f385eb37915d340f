// SPDX-License-Identifier: BSD-3-Clause
#include "live/loaded_module.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

// Installed programs share a folder beside that of the libraries. In the build tree, tests share a folder,
// and each other program has its own.
fs::path module_file(const fs::path& name) {
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path installed = folder.parent_path() / PSI_SLAM_MODULE_FOLDER / name;
  for (const fs::path& file : {installed, folder.parent_path() / "modules" / name,
                               folder.parent_path().parent_path() / "modules" / name})
    if (fs::exists(file, ignored)) return file;
  return installed;
}

}  // namespace

void* function_of_module(const std::string& module, const char* function, const std::string& content,
                         const std::string& remedy) {
  const fs::path file = module_file(module);
  void* const loaded = ::dlopen(file.c_str(), RTLD_NOW);  // stays loaded
  void* const found = loaded != nullptr ? ::dlsym(loaded, function) : nullptr;
  if (found == nullptr)
    throw UserError("cannot load " + content + " from " + file.string() + ": " + ::dlerror() + ". " + remedy);
  return found;
}

}  // namespace psi_slam
