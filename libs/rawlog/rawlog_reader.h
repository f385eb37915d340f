// SPDX-License-Identifier: BSD-3-Clause
// MRPT rawlogs, plain or gzipped, in both forms that are in use:
//
// - actions and sensory frames: odometry is the sum of the increments of the actions; every scan of a sensory
// frame has
//   the odometry of that frame;
// - observations one by one (in sensory frames or not): odometry is absolute, in observations of its own, and
//   interpolated at each scan's time.
//
// The kind of odometry that comes first decides; where both exist the other is left unread. Scans come from
// one sensor, by default the first in the log, or from several. Time stamps, in ticks of 100 ns since 1601
// there, become Unix time to the nearest microsecond.
//
// Each frame is the scan of one laser, also where several are read: SynchronizedSource puts them together.
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

/// What a rawlog reader met besides the frames it gave.
struct RawlogStatistics {
  std::string sensor_label;  ///< of the laser that scans come from, or several with commas; may be empty in
                             ///< the log, too
  bool has_actions = false;  ///< form: actions and sensory frames, or observations one by one
  std::map<std::string, std::size_t> scans_of_other_lasers;  ///< by sensor label
};

class RawlogReader : public FrameSource {
 public:
  /// Reads on until it has found a laser and odometry. Throws UserError when the log lacks one of them.
  RawlogReader(const std::filesystem::path& path, const LogOptions& options);
  ~RawlogReader() override;

  std::optional<Frame> next() override;
  double progress() const override;
  const RawlogStatistics& statistics() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
