// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include <utility>

#include "psi_slam/user_error.h"
#include "carmen/carmen_reader.h"
#include "frames/deskewed_source.h"
#include "frames/laser_choice.h"
#include "frames/log_format.h"
#include "rawlog/rawlog_reader.h"
#include "rosbag/rosbag_reader.h"
#include "frames/synchronized_source.h"

namespace psi_slam {
namespace {

/// Every nth frame of another source, from the first on, numbered anew.
class ThinnedSource : public FrameSource {
 public:
  ThinnedSource(std::unique_ptr<FrameSource> source, std::size_t every_nth)
      : source_(std::move(source)), every_nth_(every_nth) {}

  std::optional<Frame> next() override {
    while (auto frame = source_->next()) {
      if (frame->index % every_nth_ != 0) continue;
      frame->index /= every_nth_;
      return frame;
    }
    return std::nullopt;
  }

  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }

 private:
  std::unique_ptr<FrameSource> source_;
  std::size_t every_nth_;
};

std::unique_ptr<FrameSource> open_as_recorded(const std::filesystem::path& path, LogFormat format,
                                              const LogOptions& options) {
  switch (format) {
    case LogFormat::kCarmen:
      return std::make_unique<CarmenReader>(path, options);
    case LogFormat::kMrptRawlog:
      return std::make_unique<RawlogReader>(path, options);
    case LogFormat::kRos1Bag:
    case LogFormat::kRos2Sqlite:
    case LogFormat::kRos2Mcap:
    case LogFormat::kRos2Folder:
      return std::make_unique<RosbagReader>(path, options);
  }
  throw SystemFailure("a log format without reader");
}

/// Only bags may state how long a sweep takes.
bool may_be_skewed(LogFormat format, const LogOptions& options) {
  return options.sweep_time_s ? *options.sweep_time_s > 0 : is_bag(format);
}

}  // namespace

std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options) {
  check_log_options(options);
  const LogFormat format = detect_log_format(path);
  auto source = open_as_recorded(path, format, options);
  if (reads_several_lasers(options, format)) source = std::make_unique<SynchronizedSource>(std::move(source));
  if (may_be_skewed(format, options))
    source = std::make_unique<DeskewedSource>(std::move(source), options.sweep_time_s);
  if (options.every_nth_scan == 1) return source;
  return std::make_unique<ThinnedSource>(std::move(source), options.every_nth_scan);
}

}  // namespace psi_slam
