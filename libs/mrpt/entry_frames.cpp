// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/entry_frames.h"

#include <utility>

#include "logs/frames/laser_choice.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

EntryFrames::EntryFrames(const LogOptions& options, std::string speaker)
    : speaker_(std::move(speaker)),
      scans_(options),
      several_lasers_(reads_several_lasers(options, LogFormat::kMrptRawlog)),
      learns_max_ranges_(!options.max_range_m) {
  check_log_options(options);
  if (options.calibrate || options.odometry_scale || !stated_delays(options).empty())
    throw UserError(speaker_ +
                    ": log.calibrate, log.odometry_scale and log.scan_delay_s do not apply to the entries of "
                    "a rawlog. Leave them out, or map the log with psi-slam");
}

void EntryFrames::take(const mrpt::obs::CActionCollection::Ptr& action,
                       const mrpt::obs::CSensoryFrame::Ptr& observations,
                       const mrpt::obs::CObservation::Ptr& observation) {
  if (action) scans_.take(*action, speaker_ + ": action " + std::to_string(++actions_));
  if (observation) take(*observation);
  if (!observations) return;
  for (const mrpt::obs::CObservation::Ptr& one : *observations) take(*one);
}

void EntryFrames::take(const mrpt::obs::CObservation& observation) {
  scans_.take(observation, speaker_ + ": observation " + std::to_string(++observations_));
}

std::optional<Frame> EntryFrames::next_scan() {
  std::optional<Frame> frame = scans_.next();
  if (!frame || !learns_max_ranges_) return frame;
  study_.learn(frame->scan, max_ranges_);
  apply_max_range(max_ranges_, frame->scan);
  return frame;
}

std::optional<Frame> EntryFrames::next() {
  std::optional<Frame> frame;
  if (several_lasers_) {
    while (auto scan = next_scan()) synchronizer_.add(*std::move(scan));
    if (ended_) synchronizer_.end_of_log();
    frame = synchronizer_.take();
  } else {
    frame = next_scan();
  }
  if (!frame) return std::nullopt;
  opened_by_ = frame->index;
  frame->index = frames_++;
  return frame;
}

void EntryFrames::end_of_log() {
  scans_.end_of_log();
  ended_ = true;
}

}  // namespace psi_slam
