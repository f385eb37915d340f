// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/graphslam/log_entries.h"

#include <mrpt/obs/CActionRobotMovement3D.h>

#include "psi_slam/logs/log_format.h"
#include "psi_slam/logs/open_log.h"
#include "psi_slam/logs/rawlog_archive.h"
#include "psi_slam/results/range_observation.h"
#include "psi_slam/results/robot_action.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;

/// Stands where a sensory frame has no action: MRPT's engine wants one, for its time.
CActionCollection::Ptr no_movement(const CSensoryFrame& frame) {
  constexpr double kVariance = 1e-6;  // MRPT's deciders invert it
  mrpt::obs::CActionRobotMovement3D action;
  if (frame.size() > 0) action.timestamp = (*frame.begin())->timestamp;
  action.poseChange.cov.setDiagonal(kVariance);
  auto collection = CActionCollection::Create();
  collection->insert(action);
  return collection;
}

class RawlogEntries : public LogEntries {
 public:
  explicit RawlogEntries(const std::filesystem::path& rawlog) : archive_(rawlog) {}

  // Objects that are none of the three, as comments, are passed over.
  std::optional<LogEntry> next() override {
    LogEntry entry;
    while (const auto object = archive_.next()) {
      if (const auto action = std::dynamic_pointer_cast<CActionCollection>(object)) {
        entry.action = action;
      } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
        if (!entry.action || entry.action->size() == 0) entry.action = no_movement(*frame);
        entry.observations = frame;
        return entry;
      } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
        entry.action.reset();
        entry.observation = observation;
        return entry;
      }
    }
    return std::nullopt;
  }

  double progress() const override { return archive_.progress(); }
  bool are_made() const override { return false; }

 private:
  RawlogArchive archive_;
};

class FrameEntries : public LogEntries {
 public:
  explicit FrameEntries(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<LogEntry> next() override {
    const std::optional<Frame> frame = source_->next();
    if (!frame) return std::nullopt;
    mrpt::math::TPose2D motion;
    if (last_ && frame->has_odometry) motion = frame->odom_T_robot - *last_;
    last_ = frame->odom_T_robot;
    LogEntry entry;
    entry.action = CActionCollection::Create(robot_action(motion, frame->time_us));
    entry.observations = CSensoryFrame::Create();
    for (const auto& observation : range_observations(*frame)) entry.observations->insert(observation);
    return entry;
  }

  double progress() const override { return source_->progress(); }
  bool are_made() const override { return true; }

 private:
  std::unique_ptr<FrameSource> source_;
  std::optional<mrpt::math::TPose2D> last_;
};

}  // namespace

std::unique_ptr<LogEntries> open_log_entries(const std::filesystem::path& log, const LogOptions& options) {
  if (detect_log_format(log) == LogFormat::kMrptRawlog) return std::make_unique<RawlogEntries>(log);
  return std::make_unique<FrameEntries>(open_log(log, options));
}

}  // namespace psi_slam
