// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/open_log.h"

#include <utility>

#include "frames/log_reader.h"
#include "logs/frame_pipeline.h"

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

std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options) {
  check_log_options(options);
  return frames_to_map(open_log_reader(path, options), detect_log_format(path), options);
}

}  // namespace psi_slam
