// SPDX-License-Identifier: BSD-3-Clause
#include "logs/carmen/carmen_lasers.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/compression/line_reader.h"
#include "base/text_parts.h"
#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/pose_tolerance.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Messages = std::set<std::string, std::less<>>;

const std::vector<std::string> kFrontMessages{"ROBOTLASER1", "FLASER", "RAWLASER1"};
const std::vector<std::string> kRearMessages{"ROBOTLASER2", "RLASER", "RAWLASER2"};
const std::vector<std::string> kOtherMessages{"RAWLASER3", "RAWLASER4"};
constexpr std::size_t kAllLines = std::numeric_limits<std::size_t>::max();
constexpr double kEnoughPath_m = 3.0;
constexpr double kEnoughTurn_rad = 1.0;
// Poses in logs are rounded to a micrometre or a millimetre.
constexpr PoseTolerance kSameMount{0.002, 0.002};

Messages messages_in(const CarmenText& text, std::size_t most_lines) {
  LineReader lines = text.lines();
  Messages found;
  std::string_view line;
  for (std::size_t i = 0; i < most_lines && lines.next_readable(line); ++i) {
    const std::string_view name = line.substr(0, line.find_first_of(" \t"));
    if (found.find(name) == found.end()) found.emplace(name);
  }
  return found;
}

/// Returns the first of the preferred messages that was found; empty if none was found.
std::string first_of(const std::vector<std::string>& preferred, const Messages& found) {
  for (const std::string& name : preferred)
    if (found.count(name) != 0) return name;
  return {};
}

std::optional<CarmenLaserMessage> readable_laser(CarmenFields& fields) {
  try {
    return read_laser(fields);
  } catch (const MalformedLine&) {  // the reader reports this line later
    return std::nullopt;
  }
}

void set_mount_by_robotlaser(const CarmenText& text, CarmenLaser& laser) {
  if (!starts_with(laser.message_name(), "ROBOTLASER")) return;
  if (const auto mount = mount_by_robotlaser(text, laser.message_name())) laser.set_mount_by_poses(*mount);
}

/// Does what carmen_laser_candidates() does, for a value of `log.laser`.
std::vector<std::vector<std::string>> messages_wanted(const LaserChoice& choice) {
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

/// Pose of a laser on the robot, if the user or the first lines of the log state it.
std::optional<TPose2D> stated_mount(const CarmenText& text, const std::string& message,
                                    const LogOptions& options) {
  CarmenLaser laser(message, options);
  set_mount_by_robotlaser(text, laser);
  LineReader lines = text.lines();
  std::string_view line;
  for (std::size_t i = 0; i < kLinesOfHead && lines.next_readable(line); ++i) {
    CarmenFields fields(line, lines);
    if (fields.message() != "PARAM") continue;
    try {
      laser.take_parameter(fields);
    } catch (const MalformedLine&) {  // the reader reports this line later
    }
  }
  return laser.stated_mount();
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

std::vector<std::vector<std::string>> carmen_laser_candidates(const LogOptions& options) {
  return messages_wanted(laser_choice("log.laser", options.laser));
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
  const auto metres = [&](const char* what) {
    const double offset_m = fields.number(what);
    if (!is_possible_mount({offset_m, 0, 0}))
      fields.fail("the laser is more than 100 m from the robot's centre, expected metres");
    return offset_m;
  };
  if (name == mount + "offset") {
    offset_m_ = metres("the laser's offset in metres");
  } else if (name == mount + "side_offset") {
    side_offset_m_ = metres("the laser's side offset in metres");
  } else if (name == mount + "angular_offset") {
    angular_offset_rad_ = fields.number("the laser's angular offset in radians");
  } else if (name == "robot_" + position_ + "_laser_max") {
    const double max_range_m = fields.number("the laser's maximum range in metres");
    if (max_range_m <= 0) fields.fail("the laser's maximum range is not positive, expected metres");
    max_range_m_ = max_range_m;
  } else if (name == "laser_" + position_ + "_laser_resolution") {
    const double resolution_deg = fields.number("the laser's resolution in degrees");
    if (resolution_deg <= 0) fields.fail("the laser's resolution is not positive, expected degrees");
    stated_resolution_rad_ = mrpt::DEG2RAD(resolution_deg);
  }
}

bool CarmenLaser::has_mount_parameters() const {
  return offset_m_ || side_offset_m_ || angular_offset_rad_;
}

std::optional<TPose2D> CarmenLaser::stated_mount() const {
  if (options_.robot_T_laser || has_mount_parameters() || mount_by_poses_) return robot_T_laser();
  return std::nullopt;
}

TPose2D CarmenLaser::robot_T_laser() const {
  if (options_.robot_T_laser) return *options_.robot_T_laser;
  if (!has_mount_parameters() && mount_by_poses_) return *mount_by_poses_;
  const double usual_heading_rad = position_ == "rear" ? M_PI : 0.0;
  TPose2D mount{offset_m_.value_or(0), side_offset_m_.value_or(0),
                angular_offset_rad_.value_or(usual_heading_rad)};
  mount.normalizePhi();
  return mount;
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
    if (const auto fault = fault_of_beams(beams, message.start_angle_rad, step_rad)) fields.fail(*fault);
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
  if (field_of_view_rad)
    if (const auto fault = fault_of_beams(2, 0, *field_of_view_rad)) fields.fail(*fault);
  if (!field_of_view_rad) {
    fields.fail(
        "a scan of " + std::to_string(beams) +
        " readings states no angles and has no usual field of view. State it with log.field_of_view_deg");
  }
  return make_bearings_rad(options_.beam_angles, beams, *field_of_view_rad);
}

LaserScan CarmenLaser::scan(CarmenLaserMessage message, const CarmenFields& fields) {
  const Geometry geometry{message.ranges_m.size(), message.start_angle_rad, message.field_of_view_rad,
                          message.resolution_rad};
  if (!bearings_ || geometry != geometry_) {
    std::vector<float> bearings = bearings_rad(message, fields);
    if (options_.mirrored) mirror(bearings);
    bearings_ = std::make_shared<const std::vector<float>>(std::move(bearings));
    geometry_ = geometry;
  }
  LaserScan scan;
  scan.robot_T_laser = robot_T_laser();
  scan.bearings_rad = bearings_;
  scan.ranges_m = std::move(message.ranges_m);
  limit_ranges(scan, options_, message.max_range_m > 0 ? message.max_range_m : max_range_m_);
  return scan;
}

std::optional<TPose2D> mount_by_robotlaser(const CarmenText& text, std::string_view message) {
  LineReader lines = text.lines();
  std::optional<TPose2D> mount;
  std::optional<TPose2D> last_robot;
  double path_m = 0;
  double turn_rad = 0;
  std::string_view line;
  while (path_m < kEnoughPath_m && turn_rad < kEnoughTurn_rad && lines.next_readable(line)) {
    CarmenFields fields(line, lines);
    if (fields.message() != message) continue;
    const auto laser = readable_laser(fields);
    if (!laser) continue;
    const TPose2D robot_T_laser = between(laser->odom_T_robot, laser->odom_T_laser);
    if (!is_possible_mount(robot_T_laser)) return std::nullopt;
    if (mount && !is_same_place(*mount, robot_T_laser, kSameMount)) return std::nullopt;
    if (!mount) mount = robot_T_laser;
    if (last_robot) {
      path_m += distance_m(*last_robot, laser->odom_T_robot);
      turn_rad += std::abs(mrpt::math::wrapToPi(laser->odom_T_robot.phi - last_robot->phi));
    }
    last_robot = laser->odom_T_robot;
  }
  return mount;
}

CarmenLasers::CarmenLasers(CarmenText text, const LogOptions& options)
    : text_(std::move(text)), options_(options) {
  const LaserChoice choice = laser_choice("log.laser", options.laser);
  for (const auto& [option, name] : lasers_with_stated_values(options)) carmen_laser_messages(name, option);
  Messages found = messages_in(text_, kLinesOfHead);
  const bool states_none = !choice.all && choice.names.empty() && !options.robot_T_laser;
  for (auto& candidates : states_none ? usual_candidates(found) : messages_wanted(choice))
    slots_.push_back({std::move(candidates), {}});
  const auto is_missing = [&](const Slot& slot) { return first_of(slot.candidates, found).empty(); };
  const bool names_several = choice.names.size() > 1;
  if (names_several && std::any_of(slots_.begin(), slots_.end(), is_missing))
    found = messages_in(text_, kAllLines);
  for (Slot& slot : slots_)
    if (const std::string message = first_of(slot.candidates, found); !message.empty()) choose(slot, message);
  if (names_several) require_all(choice);
}

/// Chooses lasers by the messages in the first lines of the log, for a user who selects none.
CarmenLasers::Candidates CarmenLasers::usual_candidates(const Messages& found) {
  std::vector<std::string> chosen;
  std::vector<std::string> left_out;
  std::vector<std::optional<TPose2D>> mounts;  // of the chosen lasers
  for (const auto& candidates : messages_wanted(LaserChoice{true, {}})) {
    const std::string message = first_of(candidates, found);
    if (message.empty()) continue;
    const auto mount = stated_mount(text_, message, options_);
    const bool can_join = mount && std::all_of(mounts.begin(), mounts.end(), [&](const auto& other) {
                            return other && !is_same_place(*mount, *other, kSameMount);
                          });
    if (chosen.empty() || can_join) {
      chosen.push_back(message);
      mounts.push_back(mount);
    } else {
      left_out.push_back(message);
    }
  }
  if (const std::string choice = choice_of_lasers(chosen, left_out); !choice.empty())
    assumptions_.push_back(choice);
  if (chosen.size() < 2) return {carmen_laser_messages("")};
  Candidates wanted;
  for (const std::string& message : chosen) wanted.push_back({message});
  return wanted;
}

std::vector<std::vector<std::string>> CarmenLasers::names() const {
  std::vector<std::vector<std::string>> names;
  for (const Slot& slot : slots_) {
    names.emplace_back();
    if (slot.laser) names.back() = {slot.laser->laser.message_name(), slot.laser->laser.position()};
  }
  return names;
}

void CarmenLasers::choose(Slot& slot, const std::string& message) {
  const auto number = static_cast<std::size_t>(&slot - slots_.data());
  slot.laser = Laser{CarmenLaser(message, options_), number, parameters_.size(), false};
  set_mount_by_robotlaser(text_, slot.laser->laser);
}

/// Throws UserError if a log lacks a selected laser, or if two selected ones are the same.
void CarmenLasers::require_all(const LaserChoice& choice) {
  const std::string log_laser = "log.laser is \"" + options_.laser + "\"";
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].laser && text_.is_stream()) {
      assumptions_.push_back(late_laser_text("log.laser", choice.names[i]));
      continue;
    }
    if (!slots_[i].laser) {
      const Messages found = messages_in(text_, kAllLines);
      std::vector<std::string> lasers;
      for (const std::string& name : carmen_laser_messages(""))
        if (found.count(name) != 0) lasers.push_back(name);
      throw UserError(log_laser + ", but " + text_.path().string() + " has no laser \"" + choice.names[i] +
                      "\", expected some of: " + quoted_list(lasers));
    }
    for (std::size_t j = 0; j < i; ++j)
      if (slots_[j].laser && slots_[j].laser->laser.message_name() == slots_[i].laser->laser.message_name())
        throw UserError(log_laser + ", but \"" + choice.names[j] + "\" and \"" + choice.names[i] +
                        "\" are the same laser: the " + slots_[i].laser->laser.message_name() +
                        " messages of " + text_.path().string() + ". Name it once");
  }
}

CarmenLasers::Laser* CarmenLasers::laser_of(std::string_view message) {
  for (Slot& slot : slots_) {
    if (slot.laser && message == slot.laser->laser.message_name()) return &*slot.laser;
    if (slot.laser ||
        std::find(slot.candidates.begin(), slot.candidates.end(), message) == slot.candidates.end())
      continue;
    choose(slot, std::string(message));
    return &*slot.laser;
  }
  return nullptr;
}

bool CarmenLasers::any_known() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.laser.has_value(); });
}

bool CarmenLasers::all_known() const {
  return std::all_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.laser.has_value(); });
}

bool CarmenLasers::any_needs_odometry() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) {
    return slot.laser && starts_with(slot.laser->laser.message_name(), "RAWLASER");
  });
}

std::vector<std::string> CarmenLasers::candidates() const {
  std::vector<std::string> all;
  for (const Slot& slot : slots_) all.insert(all.end(), slot.candidates.begin(), slot.candidates.end());
  return all;
}

}  // namespace psi_slam
