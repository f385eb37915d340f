// SPDX-License-Identifier: BSD-3-Clause
// A log as MRPT's graph-slam engine takes it, entry by entry.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

#include "psi_slam/log_options.h"

namespace psi_slam {

/// An action with a sensory frame, or else a single observation.
struct LogEntry {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr observations;
  mrpt::obs::CObservation::Ptr observation;
};

class LogEntries {
 public:
  virtual ~LogEntries() = default;
  /// The next entry, or none at the end. Throws UserError when the log breaks off.
  virtual std::optional<LogEntry> next() = 0;
  /// How much has been read, in [0, 1].
  virtual double progress() const = 0;
  /// Whether the entries say what the log's reader has made of it; then `options` have been heeded and must
  /// not be once more.
  virtual bool are_made() const = 0;
};

/// Of a rawlog the entries as they are, but for scans of other lasers than the one that is read (log.laser,
/// or the first to come). Of a log of any other format, and where several lasers are read at once, a movement
/// and the scans of all lasers, the first one's first, for each frame: MRPT's deciders take the first. Throws
/// UserError when the log cannot be opened; its next() throws when no laser has the label that was asked for.
std::unique_ptr<LogEntries> open_log_entries(const std::filesystem::path& log, const LogOptions& options);

}  // namespace psi_slam
