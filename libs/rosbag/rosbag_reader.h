// SPDX-License-Identifier: BSD-3-Clause
// ROS bags of any kind (see bag_file.h): sensor_msgs/LaserScan with the odometry of nav_msgs/Odometry or of
// the transform odom -> base_link, interpolated at each scan's own header stamp, and with the laser's mount
// out of the transforms. A message without stamp has the time at which it was recorded.
// Each frame is the scan of one laser, also where several are read: SynchronizedSource puts them together.
//
// A bag that is damaged or cut off gives all frames before that place.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Where a bag's frames come from.
struct RosbagStatistics {
  std::string scans;     ///< the topic, or several with commas
  std::string odometry;  ///< the topic, or "odom -> base_link"
  SkippedLines skipped;  ///< odometry messages without a pose
};

class RosbagReader : public FrameSource {
 public:
  /// Reads on until it has found topics and frames. Throws UserError when the bag lacks one of them.
  RosbagReader(const std::filesystem::path& path, const LogOptions& options);
  ~RosbagReader() override;

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override { return statistics().skipped; }
  const RosbagStatistics& statistics() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
