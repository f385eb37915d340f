// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_module.h"

#include <dlfcn.h>

#include <string>
#include <system_error>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModule = "psi-slam-sensors.so";

// The build tree has the module in the search path of its programs.
std::string module_file() {
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path installed = program.parent_path().parent_path() / PSI_SLAM_MODULE_FOLDER / kModule;
  return fs::is_regular_file(installed, ignored) ? installed.string() : kModule;
}

PsiSlamOpenSensors& load_module() {
  void* const module = ::dlopen(module_file().c_str(), RTLD_NOW);  // stays loaded
  void* const function = module != nullptr ? ::dlsym(module, "psi_slam_open_sensors") : nullptr;
  if (function == nullptr)
    throw UserError(std::string("cannot load ") + kModule +
                    ", which holds the drivers of sensors: " + ::dlerror() + ". Install psi-slam again");
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
