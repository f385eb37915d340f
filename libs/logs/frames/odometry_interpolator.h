// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>
#include <optional>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Finds odometry at the time of each scan, for logs with odometry and scans in separate messages. A scan
/// waits until odometry of its time or later has arrived. The pose is interpolated between the messages
/// before and after the time of the scan. If no two messages enclose the time of the scan, the scan gets the
/// pose of the previous or the next message of the log, whichever is nearer in time. take() returns scans in
/// the order of the log.
///
/// If the time of odometry steps back, the clock was set; all earlier odometry is discarded. A scan near this
/// step belongs to the clock of the odometry message before or after it, whichever is nearer in time. A scan
/// whose time steps back therefore waits for the next odometry message.
class OdometryInterpolator {
 public:
  /// Largest number of scans of a log that wait for odometry. If more scans arrive, odometry is taken to have
  /// stopped.
  static constexpr std::size_t kMaxWaiting = 1000;

  OdometryInterpolator() = default;
  /// Lets `most_waiting` scans wait instead of kMaxWaiting.
  explicit OdometryInterpolator(std::size_t most_waiting) : most_waiting_(most_waiting) {}

  void add_odometry(TimeUs time_us, const mrpt::math::TPose2D& odom_T_robot);
  void add_scan(Frame frame);
  void end_of_log() { ended_ = true; }

  /// Expects no odometry: from now on, take() returns every scan at once without odometry.
  void expect_no_odometry() { expects_odometry_ = false; }

  /// Returns the next scan if its odometry is known or not expected.
  std::optional<Frame> take();

  bool has_odometry() const { return !odometry_.empty(); }
  std::size_t waiting() const { return scans_.size(); }
  std::size_t most_waiting() const { return most_waiting_; }

 private:
  struct Odometry {
    TimeUs time_us;
    mrpt::math::TPose2D odom_T_robot;
  };

  /// A scan and its neighbouring odometry messages in the log.
  struct Scan {
    Frame frame;
    std::optional<Odometry> before;
    std::optional<Odometry> after;
    bool steps_back = false;  // earlier than the previous scan or than the oldest odometry
    bool is_placed = false;   // the odometry of the scan is final
  };

  static bool belongs_to_next_message(const Scan& scan);
  bool must_wait(const Scan& scan) const;
  void place(Scan& scan) const;
  bool place_between_messages(Frame& frame) const;

  std::size_t most_waiting_ = kMaxWaiting;
  // The last messages since time stepped back; never empty after the first message.
  std::deque<Odometry> odometry_;
  std::deque<Scan> scans_;
  std::optional<TimeUs> last_scan_us_;
  bool ended_ = false;
  bool expects_odometry_ = true;
};

}  // namespace psi_slam
