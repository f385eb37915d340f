// SPDX-License-Identifier: BSD-3-Clause
// Maps a log: writes the map, the trajectory and a report to a folder, and prints the pose of each scan.
//
//     01_map_a_log LOG FOLDER [SETTINGS.ini]
//
// The log is a CARMEN log, an MRPT rawlog or a ROS bag. Each line of the output holds time [s], x [m], y [m]
// and heading [rad] of the robot in the map.
#include <psi_slam/psi_slam.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: 01_map_a_log LOG FOLDER [SETTINGS.ini]\n";
    return 2;
  }
  try {
    psi_slam::Configuration configuration;  // every option has a default
    if (argc > 3) configuration.load(argv[3]);
    configuration.set("map.resolution_m", "0.1");  // any option of a settings file

    psi_slam::MappingSession session(argv[1], configuration);
    while (session.step()) {
      // One scan is mapped. session.mapper() has the pose of the robot and the graph so far.
    }
    session.finish();  // searches for the remaining loops and refines all poses
    session.export_to(argv[2]);

    for (const psi_slam::FrameRecord& frame : session.result().frames)
      std::cout << psi_slam::format_seconds(frame.time_us) << ' ' << frame.map_T_robot.x << ' '
                << frame.map_T_robot.y << ' ' << frame.map_T_robot.phi << '\n';
    return 0;
  } catch (const std::exception& error) {  // psi_slam::UserError: the log or a setting is wrong
    std::cerr << "01_map_a_log: " << error.what() << '\n';
    return 1;
  }
}
