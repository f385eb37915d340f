// SPDX-License-Identifier: BSD-3-Clause
#include "common/program_identity.h"

#include "program_commit.h"  // made by the build

namespace psi_slam {

std::string program_version() {
  return PSI_SLAM_VERSION;
}

std::string program_commit() {
  return PSI_SLAM_COMMIT;
}

std::string measured_by(const std::string& machine) {
  return "psi-slam " + program_version() + ", commit " + program_commit() + ", " + machine;
}

}  // namespace psi_slam
