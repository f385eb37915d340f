// SPDX-License-Identifier: BSD-3-Clause
// Lasers of a CARMEN log: which messages hold their scans, where they are mounted and what they measure.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "logs/carmen/carmen_message.h"
#include "logs/carmen/carmen_text.h"
#include "logs/frames/laser_choice.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Names of the messages that can hold scans of a laser (`LogOptions::laser`), in order of preference; of all
/// lasers if the name is empty. Throws UserError that names `option` for a laser that CARMEN does not have.
std::vector<std::string> carmen_laser_messages(const std::string& laser,
                                               const std::string& option = "log.laser");

/// Names of the messages that may hold the scans of each laser that the options choose. "all" means the
/// front laser, the rear laser, RAWLASER3 and RAWLASER4. A laser with several kinds of messages is thus read
/// once.
std::vector<std::vector<std::string>> carmen_laser_candidates(const LogOptions& options);

/// Pose of the laser on the robot, from the two poses in the ROBOTLASER lines with this name. Reads until the
/// robot has moved 3 m or turned 1 rad and skips malformed lines. Empty if there are no such lines. Empty
/// also if the difference of the two poses varies or is no possible mount: a mapper has then corrected the
/// laser's pose.
std::optional<mrpt::math::TPose2D> mount_by_robotlaser(const CarmenText& text, std::string_view message);

/// Turns the messages of one laser into scans. The user's options override PARAM lines and messages.
class CarmenLaser {
 public:
  CarmenLaser(std::string message_name, const LogOptions& options);

  const std::string& message_name() const { return message_name_; }
  const std::string& position() const { return position_; }  ///< "front", "rear", or empty for others

  /// Returns the pose of the laser on the robot if the user or the log states it.
  std::optional<mrpt::math::TPose2D> stated_mount() const;

  /// Reads name and value of a PARAM line; `fields` begin after the word "PARAM". Ignores parameters that do
  /// not describe this laser. Throws MalformedLine for an invalid value, and then changes nothing.
  void take_parameter(CarmenFields& fields);

  /// Sets the mount that applies if neither the user nor a PARAM line states one.
  void set_mount_by_poses(const mrpt::math::TPose2D& robot_T_laser) { mount_by_poses_ = robot_T_laser; }

  /// Makes a scan from a message of this laser. Throws MalformedLine, which names the line of `fields`, if
  /// the bearings of the beams are unknown.
  LaserScan scan(CarmenLaserMessage message, const CarmenFields& fields);

 private:
  bool has_mount_parameters() const;
  mrpt::math::TPose2D robot_T_laser() const;
  std::vector<float> bearings_rad(const CarmenLaserMessage& message, const CarmenFields& fields) const;

  // Number of beams; first bearing, field of view and step, radians.
  using Geometry = std::tuple<std::size_t, double, double, double>;

  std::string message_name_;
  std::string position_;
  LogOptions options_;
  std::optional<double> offset_m_;
  std::optional<double> side_offset_m_;
  std::optional<double> angular_offset_rad_;
  std::optional<mrpt::math::TPose2D> mount_by_poses_;
  double max_range_m_ = 0;  // 0: unknown
  std::optional<double> stated_resolution_rad_;
  Geometry geometry_;  // geometry of the scans that bearings_ belongs to
  BeamBearings bearings_;
};

/// Number of lines at the beginning of a log that decide which lasers are read.
inline constexpr std::size_t kLinesOfHead = 500;

/// Lasers of a log that are read. If several kinds of messages can hold the scans of a laser, the first 500
/// lines of the log decide. If these lines contain none of the messages, the first such message to appear
/// decides.
///
/// If the user selects no laser, the first 500 lines decide also how many lasers are read: all of them whose
/// mounts are stated and differ, or one laser if the mount of the preferred laser is not stated.
class CarmenLasers {
 public:
  struct Laser {
    CarmenLaser laser;
    std::size_t number = 0;            ///< number of the laser, see LaserScan::laser
    std::size_t early_parameters = 0;  ///< number of PARAM lines before the laser was known
    bool began = false;                ///< whether a scan of the laser has been read
  };

  /// Throws UserError for a selected laser that CARMEN does not have. If several lasers are named, throws
  /// UserError also if the log lacks one of them; in a stream they may appear later.
  CarmenLasers(CarmenText text, const LogOptions& options);

  /// Returns the laser whose scans are in messages with this name, or null if these messages are not read.
  Laser* laser_of(std::string_view message);

  bool several() const { return slots_.size() > 1; }
  bool any_known() const;
  bool all_known() const;
  bool any_needs_odometry() const;  ///< whether a laser has RAWLASER messages, which state no odometry

  template <class Do>
  void for_each(Do action) {
    for (Slot& slot : slots_)
      if (slot.laser) action(slot.laser->laser);
  }

  /// Keeps a PARAM line for lasers that are not known yet.
  void keep_parameter(std::string_view line) { parameters_.emplace_back(line); }
  const std::deque<std::string>& parameters() const { return parameters_; }

  /// Names of all messages that may hold scans of the selected lasers, in order of preference.
  std::vector<std::string> candidates() const;

  /// Says which lasers were selected, if the user selects none and the log has several, and which selected
  /// ones a stream lacks so far.
  const std::vector<std::string>& assumptions() const { return assumptions_; }

  /// Returns the names of each selected laser, as in LogContents::laser_names.
  std::vector<std::vector<std::string>> names() const;

 private:
  struct Slot {
    std::vector<std::string> candidates;
    std::optional<Laser> laser;
  };

  using Candidates = std::vector<std::vector<std::string>>;  // for each laser

  Candidates usual_candidates(const std::set<std::string, std::less<>>& found);
  void choose(Slot& slot, const std::string& message);
  void require_all(const LaserChoice& choice);

  CarmenText text_;
  LogOptions options_;
  std::vector<Slot> slots_;
  std::deque<std::string> parameters_;
  std::vector<std::string> assumptions_;
};

}  // namespace psi_slam
