// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_module.h"

#include <dlfcn.h>

#include <string>
#include <system_error>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

// Installed programs share a folder beside that of the libraries. In the build tree, tests share a folder,
// and each other program has its own.
fs::path module_file() {
  const fs::path name = "psi-slam-sensors.so";
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const fs::path installed = folder.parent_path() / PSI_SLAM_MODULE_FOLDER / name;
  for (const fs::path& file : {installed, folder.parent_path() / "modules" / name,
                               folder.parent_path().parent_path() / "modules" / name})
    if (fs::exists(file, ignored)) return file;
  return installed;
}

PsiSlamOpenSensors& load_module() {
  const fs::path file = module_file();
  void* const module = ::dlopen(file.c_str(), RTLD_NOW);  // stays loaded
  void* const function = module != nullptr ? ::dlsym(module, "psi_slam_open_sensors") : nullptr;
  if (function == nullptr)
    throw UserError("cannot load the drivers of sensors from " + file.string() + ": " + ::dlerror() +
                    ". Install psi-slam and MRPT's hwdrivers again");
  return *reinterpret_cast<PsiSlamOpenSensors*>(function);
}

}  // namespace

std::unique_ptr<ObjectSource> open_sensors(const std::filesystem::path& settings, const LiveControl& control,
                                           std::optional<double> idle_s) {
  static PsiSlamOpenSensors& open = load_module();
  std::unique_ptr<ObjectSource> sensors;
  open(settings, control, idle_s, sensors);
  return sensors;
}

}  // namespace psi_slam
