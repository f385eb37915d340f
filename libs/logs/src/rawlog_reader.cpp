// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/rawlog_reader.h"

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>
#include <functional>
#include <set>
#include <utility>

#include "psi_slam/base/user_error.h"
#include "psi_slam/logs/odometry_interpolator.h"
#include "psi_slam/logs/rawlog_archive.h"
#include "psi_slam/logs/rawlog_laser.h"
#include "psi_slam/logs/rawlog_objects.h"

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

struct Contents {
  std::string sensor_label;
  bool has_actions = false;
};

/// Reads on until it has found a laser, the one the user wants if he says so, and odometry.
Contents find_laser_and_odometry(const std::filesystem::path& path, const LogOptions& options) {
  RawlogArchive archive(path);
  std::optional<std::string> laser;
  std::optional<bool> has_actions;
  std::set<std::string> labels;
  while (!laser || !has_actions) {
    const auto object = archive.next();
    if (!object) break;
    const auto* actions = dynamic_cast<const CActionCollection*>(object.get());
    if (!has_actions && actions != nullptr && movement_of(*actions)) has_actions = true;
    for_each_observation(*object, [&](const CObservation& observation) {
      if (!has_actions && dynamic_cast<const CObservationOdometry*>(&observation) != nullptr)
        has_actions = false;
      if (dynamic_cast<const CObservation2DRangeScan*>(&observation) == nullptr) return;
      labels.insert(observation.sensorLabel);
      const bool wanted = options.laser.empty() || options.laser == observation.sensorLabel;
      if (!laser && wanted) laser = observation.sensorLabel;
    });
  }
  if (labels.empty()) {
    throw UserError(path.string() +
                    " has no laser scans, expected observations of class CObservation2DRangeScan");
  }
  if (!laser) {
    std::string known;
    for (const std::string& label : labels) known += (known.empty() ? "\"" : ", \"") + label + "\"";
    throw UserError("log.laser is \"" + options.laser + "\", expected the label of a laser of " +
                    path.string() + ": " + known);
  }
  if (!has_actions) {
    throw UserError(
        path.string() +
        " has no odometry, expected actions of class CActionRobotMovement2D or observations of class "
        "CObservationOdometry");
  }
  return {*laser, *has_actions};
}

}  // namespace

class RawlogReader::Implementation {
 public:
  Implementation(const std::filesystem::path& path, const LogOptions& options)
      : archive_(path), laser_(options) {
    const Contents contents = find_laser_and_odometry(path, options);
    statistics_.sensor_label = contents.sensor_label;
    statistics_.has_actions = contents.has_actions;
  }

  std::optional<Frame> next() {
    while (true) {
      if (auto frame = take_ready()) {
        frame->index = frames_given_++;
        return frame;
      }
      if (at_end_) return std::nullopt;
      if (const auto object = archive_.next()) {
        take(*object);
      } else {
        at_end_ = interpolator_.waiting() == 0;
        interpolator_.end_of_log();
      }
    }
  }

  double progress() const { return archive_.progress(); }
  const RawlogStatistics& statistics() const { return statistics_; }

 private:
  std::optional<Frame> take_ready() {
    if (ready_.empty()) return interpolator_.take();
    Frame frame = std::move(ready_.front());
    ready_.pop_front();
    return frame;
  }

  void take(mrpt::serialization::CSerializable& object) {
    const auto* actions = dynamic_cast<const CActionCollection*>(&object);
    if (statistics_.has_actions && actions != nullptr)
      if (const auto increment = movement_of(*actions)) odom_T_robot_ = odom_T_robot_ + *increment;
    for_each_observation(object, [&](const CObservation& observation) {
      if (const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation)) take_scan(*scan);
      if (statistics_.has_actions) return;
      if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation))
        take_odometry(*odometry);
    });
  }

  void take_scan(const CObservation2DRangeScan& observation) {
    if (observation.sensorLabel != statistics_.sensor_label) {
      ++statistics_.scans_of_other_lasers[observation.sensorLabel];
      return;
    }
    Frame frame;
    frame.time_us = stamp_of(observation, "scan");
    frame.scan = laser_.scan(observation, archive_.place());
    frame.odom_T_robot = odom_T_robot_;
    if (statistics_.has_actions) {
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
  RawlogLaser laser_;
  RawlogStatistics statistics_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  // the sum of the actions
  std::optional<std::string> odometry_label_;
  std::deque<Frame> ready_;
  OdometryInterpolator interpolator_;
  std::size_t frames_given_ = 0;
  bool at_end_ = false;
};

RawlogReader::RawlogReader(const std::filesystem::path& path, const LogOptions& options)
    : implementation_(std::make_unique<Implementation>(path, options)) {}

RawlogReader::~RawlogReader() = default;

std::optional<Frame> RawlogReader::next() {
  return implementation_->next();
}

double RawlogReader::progress() const {
  return implementation_->progress();
}

const RawlogStatistics& RawlogReader::statistics() const {
  return implementation_->statistics();
}

}  // namespace psi_slam
