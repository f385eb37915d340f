// SPDX-License-Identifier: BSD-3-Clause
// Frames of a robot that is driving.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "live/live_control.h"
#include "live/ros2_link.h"
#include "logs/frames/look_over.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Where the frames of a driving robot come from.
struct LiveInput {
  enum class Kind {
    kStandardInput,  ///< CARMEN lines on standard input
    kTcp,            ///< CARMEN lines that a client sends to a TCP port
    kFollow,         ///< a log that grows: CARMEN lines, a rawlog, a bag, or the folder of a ROS 2 bag
    kSensors,        ///< sensors with drivers of MRPT, described by a settings file of rawlog-grabber
    kRos2,           ///< topics of ROS 2
  };

  Kind kind = Kind::kStandardInput;
  std::uint16_t port = 0;             ///< kTcp: port; 0: the system chooses one
  std::string address = "127.0.0.1";  ///< kTcp: IPv4 address of this computer that is listened on
  std::string file;                   ///< kFollow: the log or folder; kSensors: the settings file
  std::optional<double> idle_s;       ///< ends the frames after this time without data; empty: never
  /// Duration of the part of the stream, from its first scan on and by its time stamps, that decides which
  /// lasers there are, their mounts and maximum ranges, whether there is odometry, and which readings are of
  /// the robot's own body. Frames wait for these decisions.
  double look_over_s = kUsualLookOver_s;
  Ros2Options ros2;                     ///< kRos2: name of the node, domain and topics
  std::string record;                   ///< kRos2: MCAP file that is written of all messages; empty: none
  bool replaces_record = false;         ///< kRos2: whether `record` may replace a file
  std::shared_ptr<Ros2Link> ros2_link;  ///< kRos2: an open node; empty: open_live() opens one
};

/// Returns the name of the source for messages and reports: "standard input", "TCP port 5000", "ROS 2", or
/// the name of the file or folder.
std::string name_of(const LiveInput& input);

/// Returns the frames of a live source, numbered from 0. next() waits for the next frame, and returns nothing
/// after the source has ended or should stop; the scans that were received before are returned first. Damaged
/// messages and lost connections do not end the frames. progress() is 0.
///
/// Throws UserError for options that a stream cannot follow, such as log.calibrate, and if the source cannot
/// be opened. next() throws UserError if no scan came at all.
std::unique_ptr<FrameSource> open_live(const LiveInput& input, const LogOptions& options,
                                       const LiveControl& control);

}  // namespace psi_slam
