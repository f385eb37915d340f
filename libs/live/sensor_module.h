// SPDX-License-Identifier: BSD-3-Clause
// The drivers of sensors are in a module, which is loaded when a sensor is opened. With the drivers linked,
// psi-slam would need twice the time to start and 47 MiB more memory, because MRPT's drivers link its windows
// and OpenCV's video input.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "live/live_control.h"
#include "logs/rawlog/object_source.h"

namespace psi_slam {

/// Opens the sensors of a settings file, see SensorSet. Throws UserError if the module is missing, or for the
/// reasons of SensorSet.
std::unique_ptr<ObjectSource> open_sensors(const std::filesystem::path& settings, const LiveControl& control,
                                           std::optional<double> idle_s);

}  // namespace psi_slam

extern "C" {
/// What open_sensors() calls in the module: makes a SensorSet.
using PsiSlamOpenSensors = void(const std::filesystem::path& settings, const psi_slam::LiveControl& control,
                                std::optional<double> idle_s,
                                std::unique_ptr<psi_slam::ObjectSource>& sensors);
PsiSlamOpenSensors psi_slam_open_sensors;
}
