// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_module.h"

#include "live/loaded_module.h"

namespace psi_slam {

std::unique_ptr<ObjectSource> open_sensors(const std::filesystem::path& settings, const LiveControl& control,
                                           std::optional<double> idle_s) {
  static auto* const open = reinterpret_cast<PsiSlamOpenSensors*>(
      function_of_module("psi-slam-sensors.so", "psi_slam_open_sensors", "the drivers of sensors",
                         "Install psi-slam and MRPT's hwdrivers again"));
  std::unique_ptr<ObjectSource> sensors;
  open(settings, control, idle_s, sensors);
  return sensors;
}

}  // namespace psi_slam
