// SPDX-License-Identifier: BSD-3-Clause
// Maps a log and prints where the robot was at each of its scans, in the frame of the map:
//
//     map_a_log my.log > my.poses                                      time [s], x [m], y [m], heading [deg]
//     map_a_log my.log loop_closure.enabled=false front_end.window_m=0.5 > my.poses
//
// Any option of psi-slam.ini(5) may be set. The log is an MRPT rawlog or a CARMEN log, plain or gzipped, or a
// ROS bag.
#include <mrpt/core/bits_math.h>
#include <psi_slam/time_stamp.h>
#include <psi_slam/user_error.h>
#include <session/settings.h>
#include <psi_slam/mapping_session.h>

#include <cstdio>
#include <iostream>
#include <string>
#include <vector>

namespace {

void print_poses(const psi_slam::MappingResult& result) {
  for (const psi_slam::FrameRecord& frame : result.frames)
    std::printf("%s %.4f %.4f %.3f\n", psi_slam::format_seconds(frame.time_us).c_str(), frame.map_T_robot.x,
                frame.map_T_robot.y, mrpt::RAD2DEG(frame.map_T_robot.phi));
}

/// The settings are bound to their names, "section.key", so that they can be given as text.
void map_log(const std::string& log, const std::vector<std::string>& assignments) {
  psi_slam::BoundSettings bound;
  bound.load("", assignments);  // the name of a settings file, if there is one, and what is to be changed
  psi_slam::MappingSession session(log, bound.settings);
  while (session.step()) {  // scan by scan: between two steps session.mapper() has the map so far
  }
  session.finish();  // the last search for loops, and all scans laid on each other
  print_poses(session.result());
  std::cerr << session.result().frames.size() << " scans, " << session.result().node_frames.size()
            << " nodes\n";
  // All files that the program psi-slam writes: session.export_to(psi_slam::OutputFolder::prepare("out",
  // false));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: map_a_log LOG [SECTION.KEY=VALUE]...\n";
    return 2;
  }
  try {
    map_log(argv[1], {argv + 2, argv + argc});
    return 0;
  } catch (const psi_slam::UserError& error) {  // what is wrong with the log or the settings, as a sentence
    std::cerr << "map_a_log: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "map_a_log: " << error.what() << '\n';
    return 1;
  }
}
