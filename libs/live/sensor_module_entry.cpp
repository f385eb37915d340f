// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_module.h"
#include "live/sensor_set.h"

void psi_slam_open_sensors(const std::filesystem::path& settings, const psi_slam::LiveControl& control,
                           std::optional<double> idle_s, std::unique_ptr<psi_slam::ObjectSource>& sensors) {
  sensors = std::make_unique<psi_slam::SensorSet>(settings, control, idle_s);
}
