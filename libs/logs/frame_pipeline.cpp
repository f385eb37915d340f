// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frame_pipeline.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "logs/frames/body_masked_source.h"
#include "logs/frames/corrected_odometry_source.h"
#include "logs/frames/deskewed_source.h"
#include "logs/frames/gyroscope_choice.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/max_range_source.h"
#include "logs/frames/rewindable_source.h"
#include "logs/frames/scan_synchronizer.h"
#include "logs/sweep_direction_study.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Yields every nth frame of another source, starting with the first. The index counts the yielded frames.
class ThinnedSource : public FrameSource {
 public:
  ThinnedSource(std::unique_ptr<FrameSource> source, std::size_t every_nth)
      : source_(std::move(source)), every_nth_(every_nth) {}

  std::optional<Frame> next() override {
    bool knows_turn = true;  // since the frame that was yielded last
    while (auto frame = source_->next()) {
      knows_turn = knows_turn && frame->imu_heading_rad;
      if (frame->index % every_nth_ != 0) continue;
      frame->index /= every_nth_;
      if (!knows_turn) frame->imu_heading_rad.reset();
      return frame;
    }
    return std::nullopt;
  }

  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::size_t every_nth_;
};

/// Returns the sweep timing of a log: as the options state, or as the first frames of `log` show. `lasers`
/// are the names of the lasers.
SweepTiming sweep_timing(FrameSource& log, const LogOptions& options, const std::string& lasers) {
  SweepTiming timing{options.sweep_time_s, options.sweep_direction};
  const bool has_sweeps = options.sweep_time_s.value_or(1) > 0;
  if (options.sweep_direction != SweepDirection::kAuto || !has_sweeps) return timing;
  const std::vector<SweepDirectionStudy> studies = study_sweep_directions(log, options.sweep_time_s);
  for (std::size_t laser = 0; laser < studies.size(); ++laser) {
    const SweepDirection direction = studies[laser].direction();
    timing.directions.push_back(direction);
    const bool states_backward = studies[laser].stated_sweep_time_s < 0;
    if (direction == SweepDirection::kAuto || (direction == SweepDirection::kBackward) == states_backward)
      continue;
    const std::string name =
        studies.size() == 1 ? "" : " of laser " + std::to_string(laser + 1) + " of " + lasers;
    timing.assumptions.push_back("the beams of each scan" + name + " are measured in the " +
                                 (states_backward ? "order" : "reverse order") +
                                 " of the log, as the scans show in turns. State the order with "
                                 "log.sweep_direction");
  }
  return timing;
}

/// Prepares the frames of a file or, with `look_over_s`, of a stream. `source` yields the frames of the
/// reader with these contents.
std::unique_ptr<FrameSource> prepared_frames(std::unique_ptr<FrameSource> source, const LogContents& contents,
                                             LogFormat format, const LogOptions& options,
                                             std::optional<double> look_over_s) {
  const bool several_lasers = combines_lasers(contents, options, format);
  const double odometry_scale = options.odometry_scale.value_or(1);
  const std::vector<StatedDelay> delays = stated_delays(options);
  const bool is_late =
      std::any_of(delays.begin(), delays.end(), [](const StatedDelay& delay) { return delay.delay_s != 0; });
  if (odometry_scale != 1 || is_late)
    source = std::make_unique<CorrectedOdometrySource>(
        std::move(source), odometry_scale, [&contents, delays](std::size_t laser) {
          return delay_of_laser(delays, contents.laser_names.at(laser));
        });
  // Only bags may state a sweep time.
  const bool may_be_bent = is_bag(format) || options.sweep_time_s.value_or(0) > 0;
  SweepTiming timing;
  if (may_be_bent && look_over_s) {
    timing = SweepTiming{options.sweep_time_s, options.sweep_direction};
  } else if (may_be_bent) {
    auto beginning = std::make_unique<RewindableSource>(std::move(source));
    timing = sweep_timing(*beginning, options, contents.laser);
    beginning->rewind();
    source = std::move(beginning);
  }
  if (several_lasers) source = std::make_unique<SynchronizedSource>(std::move(source));
  if (options.mask_own_body) source = std::make_unique<BodyMaskedSource>(std::move(source), look_over_s);
  if (may_be_bent) source = std::make_unique<DeskewedSource>(std::move(source), std::move(timing));
  if (options.every_nth_scan == 1) return source;
  return std::make_unique<ThinnedSource>(std::move(source), options.every_nth_scan);
}

}  // namespace

bool combines_lasers(const LogContents& contents, const LogOptions& options, LogFormat format) {
  return reads_several_lasers(options, format) || contents.several_lasers;
}

void check_options_for(LogFormat format, const std::string& log, const LogOptions& options) {
  if (!is_bag(format) && !chooses_odometry(options) && !ignores_odometry(options))
    throw UserError("log.odometry is \"" + options.odometry + "\", expected auto or none for " + log +
                    ", because topics apply to ROS bags only");
  if (format == LogFormat::kCarmen && height_slice(options))
    throw UserError("log.slice_z_m is \"" + options.slice_z_m + "\", expected an empty text for " + log +
                    ", because CARMEN logs hold no point clouds");
  if (format == LogFormat::kCarmen && names_gyroscope(options))
    throw UserError("log.imu is \"" + options.imu + "\", expected auto or none for " + log +
                    ", because CARMEN logs hold no gyroscope");
}

std::unique_ptr<FrameSource> frames_to_map(std::unique_ptr<LogReader> reader, LogFormat format,
                                           const LogOptions& options,
                                           const std::function<MaxRanges()>& max_ranges) {
  const LogContents& contents = reader->contents();  // of the reader, which becomes the innermost source
  std::unique_ptr<FrameSource> source = std::move(reader);
  if (!options.max_range_m) source = std::make_unique<MaxRangeSource>(std::move(source), max_ranges);
  return prepared_frames(std::move(source), contents, format, options, std::nullopt);
}

std::unique_ptr<FrameSource> frames_to_map(std::unique_ptr<LogReader> reader, LogFormat format,
                                           const LogOptions& options, double look_over_s) {
  const LogContents& contents = reader->contents();
  std::unique_ptr<FrameSource> source = std::move(reader);
  if (!options.max_range_m) source = std::make_unique<MaxRangeSource>(std::move(source), look_over_s);
  return prepared_frames(std::move(source), contents, format, options, look_over_s);
}

}  // namespace psi_slam
