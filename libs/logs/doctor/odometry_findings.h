// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "logs/doctor/input_doctor.h"

namespace psi_slam {

/// Judges odometry by the scans: units, signs, clocks, jumps, delay, mount and beam angles. Part of judge(),
/// which sorts the findings.
std::vector<Finding> judge_odometry(const LogDiagnosis& diagnosis);

}  // namespace psi_slam
