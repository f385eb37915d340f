// SPDX-License-Identifier: BSD-3-Clause
// Base class of the readers of all log formats, and functions that open logs.
#pragma once

#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "logs/frames/log_format.h"
#include "logs/frames/repeated_scans.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Returns whether the user wants no odometry.
inline bool ignores_odometry(const LogOptions& options) {
  return options.odometry == "none";
}

/// Returns whether the reader chooses the odometry.
inline bool chooses_odometry(const LogOptions& options) {
  return options.odometry.empty() || options.odometry == "auto";
}

/// Facts that a reader has found in a log so far, besides the frames.
struct LogContents {
  /// Source of the scans: CARMEN messages, a sensor label or a topic; several separated by commas. Empty in a
  /// CARMEN log before the first scan, and in a rawlog whose label is empty.
  std::string laser;
  bool states_beam_angles = true;
  bool several_lasers = false;  ///< whether frames may be scans of several lasers
  /// Names of each laser that is read, by its number (LaserScan::laser); the first name is that of `laser`. A
  /// laser may have no names before its first scan.
  std::vector<std::vector<std::string>> laser_names;
  SkippedLines skipped;
  std::vector<std::string> assumptions;             ///< see FrameSource::assumptions()
  std::string repeated_scans;                       ///< see RepeatedScans::sentence()
  std::map<std::string, std::size_t> messages;      ///< CARMEN: lines of each kind, ignored ones included
  std::size_t scans_with_two_poses = 0;             ///< CARMEN: scans whose pose differs from their odometry
  bool second_pose_is_mapped = false;               ///< CARMEN: that pose does not move with the robot
  std::map<std::string, std::size_t> other_lasers;  ///< rawlog: scans of lasers that are not read, by label
};

/// Reader of one format. Each frame is the scan of one laser, even if several lasers are read:
/// SynchronizedSource combines them. Leaves out scans that repeat an earlier one; see repeated_scans.h.
class LogReader : public FrameSource {
 public:
  std::optional<Frame> next() final;
  SkippedLines skipped_lines() const override { return contents_.skipped; }
  std::vector<std::string> assumptions() const override {
    std::vector<std::string> assumptions = contents_.assumptions;
    if (!contents_.repeated_scans.empty()) assumptions.push_back(contents_.repeated_scans);
    return assumptions;
  }
  const LogContents& contents() const { return contents_; }

 protected:
  /// Reads the next frame, without its index.
  virtual std::optional<Frame> read_frame() = 0;

  /// Number of frames that read_frame() returned, without those that were left out.
  std::size_t frames_read() const { return frames_given_ + ahead_.size(); }

  LogContents contents_;

 private:
  struct Ahead {
    Frame frame;
    RepeatedScans::Judgement judgement;
  };

  bool reads_on();

  std::size_t frames_given_ = 0;
  RepeatedScans repeated_;
  std::deque<Ahead> ahead_;           // frames read in advance, which next() returns or omits
  std::set<std::size_t> unchanging_;  // lasers with equal readings in LookOver::kMostScans frames
  bool is_at_end_ = false;            // of the log, while there are frames ahead
  std::exception_ptr failure_;        // thrown after the frames ahead
};

/// Returns whether open_log() combines the scans of several lasers of a log with these contents. Throws
/// UserError as reads_several_lasers() does.
bool combines_lasers(const LogContents& contents, const LogOptions& options, LogFormat format);

/// Returns whether open_log() combines the scans of several lasers of a log. Throws UserError if the log is
/// unreadable.
bool combines_lasers(const std::filesystem::path& path, const LogOptions& options);

/// Opens a log of any format with the reader of its format. Each frame is a scan of one laser as recorded;
/// `every_nth_scan`, `sweep_time_s` and `sweep_direction` do not apply. Throws UserError as open_log() does.
std::unique_ptr<LogReader> open_log_reader(const std::filesystem::path& path, const LogOptions& options);

// Each function opens a log of one format. It throws UserError if a selected laser does not exist.
// open_rawlog() and open_bag_log() read until scans, odometry and, in a bag, coordinate frames have appeared,
// or to the end of the log. They throw UserError if scans are missing.
std::unique_ptr<LogReader> open_carmen_log(const std::filesystem::path& path, const LogOptions& options);
std::unique_ptr<LogReader> open_rawlog(const std::filesystem::path& path, const LogOptions& options);
std::unique_ptr<LogReader> open_bag_log(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
