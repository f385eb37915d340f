// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/rawlog_reader.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "frames/odometry_interpolator.h"
#include "observations/mrpt_objects.h"
#include "observations/rawlog_lasers.h"
#include "psi_slam/user_error.h"
#include "rawlog/rawlog_archive.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CSensoryFrame;

void for_each_observation(mrpt::serialization::CSerializable& object,
                          const std::function<void(const CObservation&)>& take) {
  if (const auto* observation = dynamic_cast<const CObservation*>(&object)) take(*observation);
  if (const auto* frame = dynamic_cast<const CSensoryFrame*>(&object))
    for (const auto& observation : *frame) take(*observation);
}

struct LasersAndOdometry {
  std::string labels;  // separated by commas
  bool has_actions = false;
};

/// Labels that the user states, each with the name of its option.
std::vector<std::pair<std::string, std::string>> named_labels(const LogOptions& options) {
  std::vector<std::pair<std::string, std::string>> named;
  for (const std::string& label : laser_choice("log.laser", options.laser).names)
    named.emplace_back(label, "log.laser");
  for (const StatedMount& mount : stated_mounts(options)) named.emplace_back(mount.name, "log.laser_mounts");
  return named;
}

/// Reads until a laser, all lasers that the user names, and odometry have appeared.
LasersAndOdometry find_lasers_and_odometry(const std::filesystem::path& path, const LogOptions& options) {
  RawlogArchive archive(path);
  const auto named = named_labels(options);
  ChosenLasers chosen(laser_choice("log.laser", options.laser));
  std::optional<bool> has_actions;
  std::set<std::string> labels;
  const auto is_missing = [&](const auto& name) { return labels.count(name.first) == 0; };
  while (!has_actions || labels.empty() || std::any_of(named.begin(), named.end(), is_missing)) {
    const auto object = archive.next();
    if (!object) break;
    const auto* actions = dynamic_cast<const CActionCollection*>(object.get());
    if (!has_actions && actions != nullptr && movement_of(*actions)) has_actions = true;
    for_each_observation(*object, [&](const CObservation& observation) {
      if (!has_actions && dynamic_cast<const CObservationOdometry*>(&observation) != nullptr)
        has_actions = false;
      if (dynamic_cast<const CObservation2DRangeScan*>(&observation) == nullptr) return;
      labels.insert(observation.sensorLabel);
      chosen.number_of(observation.sensorLabel);
    });
  }
  if (labels.empty()) {
    throw UserError(path.string() +
                    " has no laser scans, expected observations of class CObservation2DRangeScan");
  }
  if (const auto missing = std::find_if(named.begin(), named.end(), is_missing); missing != named.end()) {
    throw UserError(missing->second + " is \"" + missing->first + "\", expected the label of a laser of " +
                    path.string() + ": " + quoted_list({labels.begin(), labels.end()}));
  }
  if (!has_actions) {
    throw UserError(
        path.string() +
        " has no odometry, expected actions of class CActionRobotMovement2D or observations of class "
        "CObservationOdometry");
  }
  return {name_list(chosen.names()), *has_actions};
}

class RawlogReader : public LogReader {
 public:
  RawlogReader(const std::filesystem::path& path, const LogOptions& options)
      : archive_(path), lasers_(options) {
    const LasersAndOdometry found = find_lasers_and_odometry(path, options);
    contents_.laser = found.labels;
    has_actions_ = found.has_actions;
  }

  double progress() const override { return archive_.progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    while (true) {
      if (auto frame = take_ready()) return frame;
      if (at_end_) return std::nullopt;
      if (const auto object = archive_.next()) {
        take(*object);
      } else {
        at_end_ = interpolator_.waiting() == 0;
        interpolator_.end_of_log();
      }
    }
  }

 private:
  std::optional<Frame> take_ready() {
    if (ready_.empty()) return interpolator_.take();
    Frame frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
  }

  void take(mrpt::serialization::CSerializable& object) {
    const auto* actions = dynamic_cast<const CActionCollection*>(&object);
    if (has_actions_ && actions != nullptr)
      if (const auto increment = movement_of(*actions)) odom_T_robot_ = odom_T_robot_ + *increment;
    for_each_observation(object, [&](const CObservation& observation) {
      if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) take_scan(*scan);
      if (has_actions_) return;
      if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation))
        take_odometry(*odometry);
    });
  }

  void take_scan(const CObservation2DRangeScan& observation) {
    auto scan = lasers_.scan(observation, archive_.place());
    if (!scan) {
      ++contents_.other_lasers[observation.sensorLabel];
      return;
    }
    Frame frame;
    frame.time_us = stamp_of(observation, "scan");
    frame.scan = *std::move(scan);
    frame.odom_T_robot = odom_T_robot_;
    if (has_actions_) {
      ready_.push_back(std::move(frame));
    } else {
      interpolator_.add_scan(std::move(frame));
    }
  }

  void take_odometry(const CObservationOdometry& observation) {
    if (!odometry_label_) odometry_label_ = observation.sensorLabel;
    if (observation.sensorLabel != *odometry_label_) return;
    interpolator_.add_odometry(stamp_of(observation, "odometry"), observation.odometry.asTPose());
  }

  TimeUs stamp_of(const CObservation& observation, const char* what) const {
    if (const auto stamp = time_us(observation)) return *stamp;
    throw UserError(archive_.place() + ": the " + what +
                    " has no time stamp, expected one on every observation");
  }

  RawlogArchive archive_;
  RawlogLasers lasers_;
  bool has_actions_ = false;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  // sum of the actions
  std::optional<std::string> odometry_label_;
  std::deque<Frame> ready_;
  OdometryInterpolator interpolator_;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_rawlog(const std::filesystem::path& path, const LogOptions& options) {
  return std::make_unique<RawlogReader>(path, options);
}

}  // namespace psi_slam
