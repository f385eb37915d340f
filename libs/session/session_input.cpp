// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_input.h"

#include <algorithm>
#include <utility>

#include "base/file_checksum.h"
#include "logs/frames/log_reader.h"
#include "map/exports/map_files.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "session/read_ahead.h"
#include "session/session_file.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

/// Returns the name of the file or folder; the name of "runs/" is "runs".
std::string name_of(const std::filesystem::path& log) {
  return (log.has_filename() ? log : log.parent_path()).filename().string();
}

/// Returns the calibration of a log that continues `last`: the robot and its lasers stay the same.
std::optional<LogCalibration> continued(const RecordedLog& last, const std::string& name) {
  if (!last.calibration || last.calibration->estimates.empty()) return std::nullopt;
  LogCalibration calibration = *last.calibration;
  for (CalibratedOption& estimate : calibration.estimates) estimate.log = name;
  const bool is_estimated = std::any_of(calibration.estimates.begin(), calibration.estimates.end(),
                                        [](const CalibratedOption& estimate) { return !estimate.is_fault; });
  calibration.sentences = {is_estimated ? "log.calibrate keeps the estimates of " + last.name
                                        : "the laser is read as in " + last.name};
  return calibration;
}

/// Recorded frames, followed by the frames of a log. skipped_lines() covers only the last log, because the
/// recording states the skipped lines of the earlier logs.
class RecordedSource : public FrameSource {
 public:
  /// Joins a recording and `log`, which has the path `path` and is at its beginning. If `is_last`, `log` is
  /// the last log of the recording, and its rest follows the recorded frames. Otherwise all of `log` follows
  /// them. Without `log` the frames end as they did when they were recorded: at the end of the last log or
  /// with its damage. Throws UserError if `log` is another log and begins before the recording ends.
  RecordedSource(std::shared_ptr<const SessionRecording> recording, std::unique_ptr<FrameSource> log,
                 bool is_last, std::filesystem::path path)
      : recording_(std::move(recording)), log_(std::move(log)), is_last_(is_last), path_(std::move(path)) {
    if (!log_ || is_last_) return;
    first_ = log_->next();
    if (first_) first_->imu_heading_rad.reset();  // the headings of two logs are unrelated
    const std::vector<Frame>& frames = recording_->frames;
    if (!first_ || frames.empty() || first_->time_us > frames.back().time_us) return;
    const char* const why = recording_->facts.logs.back().sha256.empty()
                                ? " cannot be compared with the log of the session (which was live, or "
                                  "unreadable when it was saved)"
                                : " is not the log of the session (their checksums differ)";
    throw UserError(path_.string() + why + " and does not continue it: its first scan is at " +
                    format_seconds(first_->time_us) + " s, the session's last scan at " +
                    format_seconds(frames.back().time_us) +
                    " s. Resume without a log, with the log of the session, or with one that follows it");
  }

  std::optional<Frame> next() override {
    const std::vector<Frame>& frames = recording_->frames;
    if (next_ < frames.size()) {
      if (log_ && is_last_) skip_recorded();
      return frames[next_++];
    }
    if (!log_) {
      if (const auto& broken_off = recording_->facts.logs.back().broken_off) throw UserError(*broken_off);
      return std::nullopt;
    }
    std::optional<Frame> frame = first_ ? std::exchange(first_, std::nullopt) : log_->next();
    if (frame) frame->index = next_++;
    return frame;
  }

  // The length of the log that continues the recording is unknown, so the recording counts as half of the
  // total.
  double progress() const override {
    if (log_ && is_last_) return log_->progress();
    const std::size_t recorded = recording_->frames.size();
    const double share = recorded == 0 ? 1 : static_cast<double>(next_) / static_cast<double>(recorded);
    if (!log_) return share;
    return next_ < recorded ? 0.5 * share : 0.5 + 0.5 * log_->progress();
  }

  SkippedLines skipped_lines() const override {
    return log_ ? log_->skipped_lines() : recording_->facts.logs.back().skipped;
  }
  std::vector<std::string> assumptions() const override {
    return log_ ? log_->assumptions() : recording_->facts.logs.back().assumptions;
  }

 private:
  // Reads the log along with its recorded frames, so that its progress and skipped lines are correct.
  void skip_recorded() {
    const std::size_t of_logs_before = recording_->frames.size() - recording_->facts.logs.back().scans;
    if (next_ >= of_logs_before && !log_->next())
      throw UserError(
          path_.string() +
          " holds fewer scans than the session recorded from it. Resume with the log that was recorded.");
  }

  std::shared_ptr<const SessionRecording> recording_;
  std::unique_ptr<FrameSource> log_;  ///< null if no log continues the recording
  bool is_last_;                      ///< whether log_ is the last log of the recording
  std::filesystem::path path_;
  /// First frame of `log_`, which the constructor reads if `log_` is not the last log of the recording. Empty
  /// otherwise, and after next() has returned the frame.
  std::optional<Frame> first_;
  std::size_t next_ = 0;
};

/// Recorded frames, followed by those of a stream, which is not read before. progress() is 0.
class ResumedStream : public FrameSource {
 public:
  ResumedStream(std::shared_ptr<const SessionRecording> recording, std::unique_ptr<FrameSource> stream)
      : recording_(std::move(recording)), stream_(std::move(stream)) {}

  std::optional<Frame> next() override {
    const std::vector<Frame>& recorded = recording_->frames;
    if (next_ < recorded.size()) return recorded[next_++];
    std::optional<Frame> frame = stream_->next();
    if (!frame) return std::nullopt;
    if (next_ == recorded.size()) frame->imu_heading_rad.reset();  // unrelated to the recorded headings
    frame->index = next_++;
    return frame;
  }
  double progress() const override { return 0; }
  SkippedLines skipped_lines() const override { return stream_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return stream_->assumptions(); }

 private:
  std::shared_ptr<const SessionRecording> recording_;
  std::unique_ptr<FrameSource> stream_;
  std::size_t next_ = 0;
};

}  // namespace

std::uintmax_t bytes_on_disk(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t bytes =
      std::filesystem::is_regular_file(path, error) ? std::filesystem::file_size(path, error) : 0;
  return error ? 0 : bytes;
}

SessionInput::SessionInput(std::filesystem::path log)
    : log_(std::move(log)), log_bytes_(bytes_on_disk(log_)), logs_{{name_of(log_), "", 0}} {}

SessionInput::SessionInput(const std::string& name, OpenStream open)
    : open_stream_(std::move(open)), logs_{{name, "", 0}} {}

SessionInput::SessionInput(std::shared_ptr<const SessionRecording> recording, std::filesystem::path log)
    : recording_(std::move(recording)),
      log_(std::move(log)),
      log_bytes_(bytes_on_disk(log_)),
      logs_(recording_->facts.logs),
      edits_(recording_->facts.edits) {
  edits_.rewind();
  if (log_.empty()) return;
  if (!std::filesystem::exists(log_))
    throw UserError(log_.string() + " does not exist, expected a log file. Check the path");
  const std::string sha256 = sha256_of_log(log_);
  same_log_ = logs_.back().sha256 == sha256;
  if (same_log_) {  // the log is read from its beginning, which finds its skipped lines and damage again
    RecordedLog& last = logs_.back();
    last.skipped = SkippedLines();
    last.broken_off.reset();
    last.scans_left = false;
    return;
  }
  if (std::any_of(logs_.begin(), logs_.end(),
                  [&](const RecordedLog& known) { return known.sha256 == sha256; }))
    throw UserError(log_.string() + " is already in the session, before " + logs_.back().name +
                    ". Resume with " + logs_.back().name + " or with a log that follows it");
  RecordedLog next{name_of(log_), sha256, 0};
  next.calibration = continued(logs_.back(), next.name);
  keeps_calibration_ = next.calibration.has_value();
  logs_.push_back(std::move(next));
}

SessionInput::SessionInput(std::shared_ptr<const SessionRecording> recording, const std::string& name,
                           OpenStream open)
    : SessionInput(std::move(recording)) {
  open_stream_ = std::move(open);
  RecordedLog& last = logs_.back();
  if (last.sha256.empty()) last.scans_left = false;  // a stream has no rest that could be read
  logs_.push_back({name, "", 0});
}

SessionInput SessionInput::of_file(const std::filesystem::path& path) {
  if (!is_session_file(path)) return SessionInput(path);
  return SessionInput(std::make_shared<const SessionRecording>(read_session_file(path)));
}

SessionInput SessionInput::with_edits(EditJournal edits) const {
  SessionInput input = *this;
  input.edits_ = std::move(edits);
  input.edits_.rewind();
  return input;
}

void SessionInput::calibrate(const LogOptions& options, const ShareObserver& progress) {
  RecordedLog& last = logs_.back();
  if (log_.empty()) return;
  if (keeps_calibration_) check_kept_calibration(options);
  // The rest of a recorded log is read as its beginning was.
  if (last.calibration || ((is_examined_ || same_log_) && !options.calibrate)) return;
  is_examined_ = true;
  LogCalibration calibration = calibrate_log(log_, options, progress);
  if (!options.calibrate && calibration.sentences.empty()) return;
  for (CalibratedOption& estimate : calibration.estimates) estimate.log = last.name;
  last.calibration = std::move(calibration);
}

void SessionInput::check_kept_calibration(const LogOptions& options) {
  LogCalibration& calibration = *logs_.back().calibration;
  if (combines_lasers(log_, options) && unuse_mount(calibration))
    calibration.sentences.push_back("the poses of several lasers are left unchanged");
  try {
    open_log_reader(log_, calibrated_options(options, calibration));
  } catch (const UserError& error) {
    const std::string& before = logs_.at(logs_.size() - 2).name;
    throw UserError(log_.string() + " keeps the calibration of " + before + ", but has other lasers: " +
                    error.what() + ". Map this log by itself, and combine both with psi-slam merge");
  }
}

void SessionInput::require_unshortened() const {
  std::error_code missing;  // open_log() says so
  if (std::filesystem::exists(log_, missing) && bytes_on_disk(log_) < log_bytes_)
    throw UserError(log_.string() +
                    " became shorter while it was read, expected a log that is complete. Fetch it again");
}

std::unique_ptr<FrameSource> SessionInput::open(const LogOptions& options) const {
  if (open_stream_ && recording_) return std::make_unique<ResumedStream>(recording_, open_stream_(options));
  if (open_stream_) return open_stream_(options);
  require_unshortened();
  std::unique_ptr<FrameSource> opened = recording_ && log_.empty() ? nullptr : open_log(log_, options);
  require_unshortened();  // the log was looked over
  if (!recording_) return opened;
  return std::make_unique<RecordedSource>(recording_, std::move(opened), same_log_, log_);
}

void check(const Settings& settings) {
  check_values(settings);
  check_epsg(settings.map_files.earth.epsg);
}

OpenedInput open_input(const SessionInput& input, const Settings& settings) {
  check(settings);
  OpenedInput opened;
  SessionInput calibrated = input;
  calibrated.calibrate(log_options(settings));
  opened.calibration = calibrated.logs().back().calibration;
  opened.frames =
      input.open(calibrated_options(log_options(settings), opened.calibration.value_or(LogCalibration())));
  if (input.is_stream() || worker_threads(settings.run) > 1)
    opened.frames = std::make_unique<ReadAhead>(std::move(opened.frames));
  return opened;
}

std::string names_of(const std::vector<RecordedLog>& logs) {
  std::string names;
  for (const RecordedLog& log : logs) names += (names.empty() ? "" : " + ") + log.name;
  return names;
}

}  // namespace psi_slam
