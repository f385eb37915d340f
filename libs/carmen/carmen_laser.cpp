// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_laser.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "psi_slam/user_error.h"
#include "frames/range_filter.h"

namespace psi_slam {
namespace {

const std::vector<std::string> kFrontMessages{"ROBOTLASER1", "FLASER", "RAWLASER1"};
const std::vector<std::string> kRearMessages{"ROBOTLASER2", "RLASER", "RAWLASER2"};
const std::vector<std::string> kOtherMessages{"RAWLASER3", "RAWLASER4"};

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> carmen_laser_messages(const std::string& laser, const std::string& option) {
  if (laser == "front") return kFrontMessages;
  if (laser == "rear") return kRearMessages;
  std::vector<std::string> all = kFrontMessages;
  all.insert(all.end(), kRearMessages.begin(), kRearMessages.end());
  all.insert(all.end(), kOtherMessages.begin(), kOtherMessages.end());
  if (laser.empty()) return all;
  if (contains(all, laser)) return {laser};
  throw UserError(
      option + " is \"" + laser +
      "\", expected \"front\", \"rear\" or the name of a CARMEN laser message such as \"RAWLASER1\"");
}

std::vector<std::vector<std::string>> carmen_lasers_wanted(const LaserChoice& choice) {
  std::vector<std::vector<std::string>> wanted;
  if (choice.all) {
    wanted = {kFrontMessages, kRearMessages};
    for (const std::string& name : kOtherMessages) wanted.push_back({name});
    return wanted;
  }
  if (choice.names.empty()) return {carmen_laser_messages("")};
  for (const std::string& name : choice.names) wanted.push_back(carmen_laser_messages(name));
  return wanted;
}

CarmenLaser::CarmenLaser(std::string message_name, const LogOptions& options)
    : message_name_(std::move(message_name)),
      position_(contains(kFrontMessages, message_name_)  ? "front"
                : contains(kRearMessages, message_name_) ? "rear"
                                                         : ""),
      options_(options_of_laser(options, {message_name_, position_})) {}

void CarmenLaser::take_parameter(CarmenFields& fields) {
  const std::string_view name = fields.word("the parameter's name");
  if (position_.empty()) return;
  const std::string mount = "robot_" + position_ + "laser_";
  if (name == mount + "offset") {
    offset_m_ = fields.number("the laser's offset in metres");
  } else if (name == mount + "side_offset") {
    side_offset_m_ = fields.number("the laser's side offset in metres");
  } else if (name == mount + "angular_offset") {
    angular_offset_rad_ = fields.number("the laser's angular offset in radians");
  } else if (name == "robot_" + position_ + "_laser_max") {
    const double max_range_m = fields.number("the laser's maximum range in metres");
    if (max_range_m <= 0) fields.fail("the laser's maximum range is not positive, expected metres");
    stated_max_range_m_ = max_range_m;
  } else if (name == "laser_" + position_ + "_laser_resolution") {
    const double resolution_deg = fields.number("the laser's resolution in degrees");
    if (resolution_deg <= 0) fields.fail("the laser's resolution is not positive, expected degrees");
    stated_resolution_rad_ = mrpt::DEG2RAD(resolution_deg);
  }
}

bool CarmenLaser::has_mount_parameters() const {
  return offset_m_ || side_offset_m_ || angular_offset_rad_;
}

bool CarmenLaser::knows_mount() const {
  return options_.robot_T_laser || has_mount_parameters() || mount_by_poses_;
}

mrpt::math::TPose2D CarmenLaser::robot_T_laser() const {
  if (options_.robot_T_laser) return *options_.robot_T_laser;
  if (!has_mount_parameters() && mount_by_poses_) return *mount_by_poses_;
  const double usual_heading_rad = position_ == "rear" ? M_PI : 0.0;
  mrpt::math::TPose2D mount{offset_m_.value_or(0), side_offset_m_.value_or(0),
                            angular_offset_rad_.value_or(usual_heading_rad)};
  mount.normalizePhi();
  return mount;
}

double CarmenLaser::max_range_m(const CarmenLaserMessage& message) const {
  if (options_.max_range_m) return *options_.max_range_m;
  if (message.max_range_m > 0) return message.max_range_m;
  return stated_max_range_m_.value_or(kUnstatedMaxRange_m);
}

std::vector<float> CarmenLaser::bearings_rad(const CarmenLaserMessage& message,
                                             const CarmenFields& fields) const {
  const std::size_t beams = message.ranges_m.size();
  const bool log_states_them = message.resolution_rad > 0 || message.field_of_view_rad > 0;
  if (log_states_them && options_.beam_angles == BeamAngles::kAuto && !options_.field_of_view_rad) {
    const double step_rad =
        message.resolution_rad > 0
            ? message.resolution_rad
            : message.field_of_view_rad / static_cast<double>(std::max<std::size_t>(beams - 1, 1));
    std::vector<float> bearings(beams);
    for (std::size_t i = 0; i < beams; ++i)
      bearings[i] = static_cast<float>(message.start_angle_rad + static_cast<double>(i) * step_rad);
    return bearings;
  }
  std::optional<double> field_of_view_rad = options_.field_of_view_rad;
  if (!field_of_view_rad && message.field_of_view_rad > 0) field_of_view_rad = message.field_of_view_rad;
  if (!field_of_view_rad) field_of_view_rad = usual_field_of_view_rad(beams);
  if (!field_of_view_rad && stated_resolution_rad_)
    field_of_view_rad = *stated_resolution_rad_ * static_cast<double>(beams - 1);
  if (!field_of_view_rad) {
    fields.fail(
        "a scan of " + std::to_string(beams) +
        " readings without angles has no usual field of view, expected log.field_of_view_deg to state it");
  }
  return make_bearings_rad(options_.beam_angles, beams, *field_of_view_rad);
}

bool CarmenLaser::Geometry::operator==(const Geometry& other) const {
  return beams == other.beams && start_angle_rad == other.start_angle_rad &&
         field_of_view_rad == other.field_of_view_rad && resolution_rad == other.resolution_rad;
}

LaserScan CarmenLaser::scan(CarmenLaserMessage message, const CarmenFields& fields) {
  const Geometry geometry{message.ranges_m.size(), message.start_angle_rad, message.field_of_view_rad,
                          message.resolution_rad};
  if (!bearings_ || !(geometry == geometry_)) {
    std::vector<float> bearings = bearings_rad(message, fields);
    if (options_.mirrored)
      for (float& bearing : bearings) bearing = -bearing;
    bearings_ = std::make_shared<const std::vector<float>>(std::move(bearings));
    geometry_ = geometry;
  }
  LaserScan scan;
  scan.max_range_m = static_cast<float>(max_range_m(message));
  scan.robot_T_laser = robot_T_laser();
  scan.bearings_rad = bearings_;
  scan.ranges_m = std::move(message.ranges_m);
  mark_no_returns(scan.ranges_m, options_.min_range_m, scan.max_range_m);
  return scan;
}

}  // namespace psi_slam
