// SPDX-License-Identifier: BSD-3-Clause
#include "rival_log.h"

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include "base/atomic_file.h"
#include "psi_slam/user_error.h"
#include "observations/mrpt_objects.h"

namespace psi_slam {
std::vector<TimeUs> write_rival_log(FrameSource& source, const std::filesystem::path& path,
                                    const std::function<bool()>& stop) {
  std::vector<TimeUs> times;
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    mrpt::io::CFileOutputStream file(temporary.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    mrpt::math::TPose2D odom_T_last;
    while (const std::optional<Frame> frame = source.next()) {
      if (stop()) throw SystemFailure("interrupted");
      const mrpt::math::TPose2D motion =
          times.empty() || !frame->has_odometry ? mrpt::math::TPose2D() : frame->odom_T_robot - odom_T_last;
      odom_T_last = frame->odom_T_robot;
      mrpt::obs::CSensoryFrame observations;
      for (const auto& observation : range_observations(*frame)) observations.insert(observation);
      archive << robot_action(motion, frame->time_us) << observations;
      times.push_back(frame->time_us);
    }
  });
  return times;
}

}  // namespace psi_slam
