// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/log_entries.h"

#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "logs/frames/laser_choice.h"
#include "logs/frames/log_format.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/cloud_points.h"
#include "logs/observations/mrpt_objects.h"
#include "logs/rawlog/rawlog_archive.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;

/// Returns an action without movement, for a sensory frame that no action precedes. MRPT's engine needs the
/// action's time stamp.
CActionCollection::Ptr no_movement(const CSensoryFrame& frame) {
  constexpr double kVariance = 1e-6;  // positive, because MRPT's deciders invert the covariance
  mrpt::obs::CActionRobotMovement3D action;
  if (!frame.empty()) action.timestamp = (*frame.begin())->timestamp;
  action.poseChange.cov.setDiagonal(kVariance);
  auto collection = CActionCollection::Create();
  collection->insert(action);
  return collection;
}

/// The entries of a rawlog with the scans of one laser only. MRPT's engine and deciders do not distinguish
/// lasers.
class RawlogEntries : public LogEntries {
 public:
  RawlogEntries(const std::filesystem::path& rawlog, const LogOptions& options)
      : archive_(rawlog), lasers_(laser_choice("log.laser", options.laser)), laser_(options.laser) {}

  // Skips objects that are neither actions, sensory frames nor observations.
  std::optional<LogEntry> next() override {
    LogEntry entry;
    while (const auto object = archive_.next()) {
      if (const auto action = std::dynamic_pointer_cast<CActionCollection>(object)) {
        entry.action = action;
      } else if (const auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
        if (!entry.action || entry.action->size() == 0) entry.action = no_movement(*frame);
        leave_out_other_lasers(*frame);
        entry.observations = frame;
        return entry;
      } else if (const auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
        if (is_of_another_laser(*observation)) continue;
        entry.action.reset();
        entry.observation = observation;
        return entry;
      }
    }
    if (!any_scan_ && !other_lasers_.empty())
      throw UserError("log.laser is \"" + laser_ + "\", expected the label of a laser of " +
                      archive_.path().string() + ": " +
                      quoted_list({other_lasers_.begin(), other_lasers_.end()}));
    return std::nullopt;
  }

  double progress() const override { return archive_.progress(); }
  bool are_made() const override { return false; }
  bool have_odometry() const override { return true; }

 private:
  bool is_of_another_laser(const CObservation& observation) {
    if (is_cloud(observation)) return true;  // RawlogArchive sends clouds without points unless it slices
    if (dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) == nullptr) return false;
    const bool is_other = !lasers_.number_of(observation.sensorLabel);
    if (is_other) other_lasers_.insert(observation.sensorLabel);
    any_scan_ = any_scan_ || !is_other;
    return is_other;
  }

  void leave_out_other_lasers(CSensoryFrame& frame) {
    for (auto observation = frame.begin(); observation != frame.end();)
      observation = is_of_another_laser(**observation) ? frame.erase(observation) : std::next(observation);
  }

  RawlogArchive archive_;
  ChosenLasers lasers_;
  std::string laser_;
  std::set<std::string> other_lasers_;
  bool any_scan_ = false;
};

class FrameEntries : public LogEntries {
 public:
  explicit FrameEntries(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {
    ahead_ = source_->next();
    has_odometry_ = ahead_ && ahead_->has_odometry;
  }

  std::optional<LogEntry> next() override {
    const std::optional<Frame> frame = ahead_ ? std::exchange(ahead_, std::nullopt) : source_->next();
    if (!frame) return std::nullopt;
    mrpt::math::TPose2D motion;
    if (last_ && frame->has_odometry) motion = between(*last_, frame->odom_T_robot);
    last_ = frame->odom_T_robot;
    LogEntry entry;
    entry.action = CActionCollection::Create(robot_action(motion, frame->time_us));
    entry.observations = CSensoryFrame::Create();
    for (const auto& observation : range_observations(*frame)) entry.observations->insert(observation);
    return entry;
  }

  double progress() const override { return source_->progress(); }
  bool are_made() const override { return true; }
  bool have_odometry() const override { return has_odometry_; }

 private:
  std::unique_ptr<FrameSource> source_;
  std::optional<Frame> ahead_;  ///< first frame until next() returns it
  bool has_odometry_ = false;   ///< whether the first frame has odometry
  std::optional<mrpt::math::TPose2D> last_;
};

}  // namespace

std::unique_ptr<LogEntries> open_log_entries(const std::filesystem::path& log, const LogOptions& options) {
  const LogFormat format = detect_log_format(log);
  if (format == LogFormat::kMrptRawlog && !reads_several_lasers(options, format))
    return std::make_unique<RawlogEntries>(log, options);
  return std::make_unique<FrameEntries>(open_log(log, options));
}

}  // namespace psi_slam
