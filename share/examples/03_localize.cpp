// SPDX-License-Identifier: BSD-3-Clause
// Localizes a robot in a finished map, scan by scan. Its start is unknown.
//
//     03_localize MAP LOG
//
// The map is map.yaml or map.gridmap.gz, as psi-slam writes them. The log is a CARMEN log, an MRPT rawlog or
// a ROS bag. For each scan with a known pose, the program prints time [s], x [m], y [m] and heading [rad] in
// the map.
#include <psi_slam/configuration.h>
#include <psi_slam/localizer.h>
#include <psi_slam/open_log.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: 03_localize MAP LOG\n";
    return 2;
  }
  try {
    const psi_slam::Configuration configuration;  // every option has its default
    psi_slam::Localizer localizer = psi_slam::Localizer::open(argv[1], configuration);
    const auto log = psi_slam::open_log(argv[2], configuration);
    while (const std::optional<psi_slam::Frame> frame = log->next()) {
      const psi_slam::LocalizationStep step = localizer.add(*frame);
      if (step.state == psi_slam::LocalizationStep::State::kLost) continue;
      std::cout << psi_slam::format_seconds(step.time_us) << ' ' << step.map_T_robot.x << ' '
                << step.map_T_robot.y << ' ' << step.map_T_robot.phi << '\n';
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "03_localize: " << error.what() << '\n';
    return 1;
  }
}
