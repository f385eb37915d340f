// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include <utility>

#include "logs/frame_pipeline.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/log_reader.h"

namespace psi_slam {

bool combines_lasers(const std::filesystem::path& path, const LogOptions& options) {
  return combines_lasers(open_log_reader(path, options)->contents(), options, detect_log_format(path));
}

std::unique_ptr<LogReader> open_log_reader(const std::filesystem::path& path, const LogOptions& options) {
  const LogFormat format = detect_log_format(path);
  check_options_for(format, path.string(), options);
  if (format == LogFormat::kCarmen) return open_carmen_log(path, options);
  if (format == LogFormat::kMrptRawlog) return open_rawlog(path, options);
  return open_bag_log(path, options);
}

MaxRanges max_ranges_of_log(const std::filesystem::path& path, const LogOptions& options) {
  const auto log = open_log_reader(path, options);
  return height_slice(options) ? MaxRanges() : study_max_ranges(*log);
}

std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options) {
  check_log_options(options);
  return frames_to_map(open_log_reader(path, options), detect_log_format(path), options,
                       [path, options] { return max_ranges_of_log(path, options); });
}

}  // namespace psi_slam
