// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include <utility>

#include "frames/deskewed_source.h"
#include "frames/gyroscope_choice.h"
#include "frames/height_slice.h"
#include "frames/laser_choice.h"
#include "frames/log_reader.h"
#include "frames/scan_synchronizer.h"
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

}  // namespace

std::unique_ptr<LogReader> open_log_reader(const std::filesystem::path& path, const LogOptions& options) {
  const LogFormat format = detect_log_format(path);
  if (!is_bag(format) && !chooses_odometry(options) && !ignores_odometry(options))
    throw UserError("log.odometry is \"" + options.odometry + "\", expected auto or none for " +
                    path.string() + ", because topics apply to ROS bags only");
  if (!is_bag(format) && height_slice(options))
    throw UserError("log.slice_z_m is \"" + options.slice_z_m + "\", expected an empty text for " +
                    path.string() + ", because only ROS bags hold point clouds");
  if (format == LogFormat::kCarmen && names_gyroscope(options))
    throw UserError("log.imu is \"" + options.imu + "\", expected auto or none for " + path.string() +
                    ", because CARMEN logs hold no gyroscope");
  if (format == LogFormat::kCarmen) return open_carmen_log(path, options);
  if (format == LogFormat::kMrptRawlog) return open_rawlog(path, options);
  return open_bag_log(path, options);
}

std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options) {
  check_log_options(options);
  const LogFormat format = detect_log_format(path);
  std::unique_ptr<LogReader> reader = open_log_reader(path, options);
  const bool several_lasers = reads_several_lasers(options, format) || reader->contents().several_lasers;
  std::unique_ptr<FrameSource> source = std::move(reader);
  if (several_lasers) source = std::make_unique<SynchronizedSource>(std::move(source));
  // Only bags may state a sweep time.
  const bool may_be_skewed = options.sweep_time_s ? *options.sweep_time_s > 0 : is_bag(format);
  if (may_be_skewed) source = std::make_unique<DeskewedSource>(std::move(source), options.sweep_time_s);
  if (options.every_nth_scan == 1) return source;
  return std::make_unique<ThinnedSource>(std::move(source), options.every_nth_scan);
}

}  // namespace psi_slam
