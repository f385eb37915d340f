// SPDX-License-Identifier: BSD-3-Clause
// CARMEN logs: text, one message a line, comments behind '#'.
//
// Scans come from one kind of message. By default it is the front laser's: ROBOTLASER1, else FLASER, else
// RAWLASER1, whichever the head of the log has; without any of them the rear laser's (ROBOTLASER2, RLASER,
// RAWLASER2), and then RAWLASER3 and RAWLASER4. Messages of other kinds are counted and otherwise ignored.
//
// Where several lasers are read, each frame is the scan of one of them: SynchronizedSource puts them together.
//
// Odometry at the scan's time is in the scan's own line, but for RAWLASER lines, which get it by
// interpolation between ODOM lines. FLASER lines carry a second pose, which some mapper may have corrected:
// it is never used.
//
// Lines that do not parse are left out as long as they are few: at most 1 % of the lines that were needed, or
// one. A log with more ends with a UserError, and so does one whose last line is cut off.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// What a CARMEN reader met besides the frames it gave.
struct CarmenStatistics {
  std::string laser_message;  ///< the kind that scans come from, several with commas; empty before the first
  std::map<std::string, std::size_t> messages;  ///< lines of each kind, the ignored ones too
  std::size_t scans_with_two_poses = 0;         ///< whose line carries another pose than its odometry
  SkippedLines skipped;
};

class CarmenReader : public FrameSource {
 public:
  CarmenReader(const std::filesystem::path& path, const LogOptions& options);
  ~CarmenReader() override;

  std::optional<Frame> next() override;
  double progress() const override;
  SkippedLines skipped_lines() const override { return statistics().skipped; }
  const CarmenStatistics& statistics() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
