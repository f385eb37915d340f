// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/carmen_reader.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "psi_slam/base/line_reader.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/logs/carmen_laser.h"
#include "psi_slam/logs/carmen_message.h"
#include "psi_slam/logs/carmen_mount.h"
#include "psi_slam/logs/odometry_interpolator.h"

namespace psi_slam {
namespace {

constexpr std::size_t kLinesOfHead = 500;
constexpr std::size_t kLinesForOneSkipped = 100;
constexpr std::size_t kSkippedBeforeTheEnd = 100;  // damage may come in one place, and the share sink later

bool starts_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

/// The most preferred of the messages that the first lines of the log have; empty if they have none.
std::string laser_message_in_head(const std::filesystem::path& path,
                                  const std::vector<std::string>& preferred) {
  LineReader lines(path);
  std::set<std::string, std::less<>> found;
  std::string_view line;
  for (std::size_t i = 0; i < kLinesOfHead && lines.next(line); ++i)
    found.emplace(line.substr(0, line.find_first_of(" \t")));
  for (const std::string& name : preferred)
    if (found.count(name) != 0) return name;
  return {};
}

}  // namespace

class CarmenReader::Implementation {
 public:
  Implementation(const std::filesystem::path& path, const LogOptions& options)
      : options_(options), candidates_(carmen_laser_messages(options.laser)), lines_(path) {
    const std::string message = laser_message_in_head(path, candidates_);
    if (!message.empty()) choose_laser(message);
  }

  std::optional<Frame> next() {
    std::string_view line;
    while (true) {
      if (auto frame = interpolator_.take()) return numbered(std::move(frame));
      if (at_end_) return std::nullopt;
      if (lines_.next(line)) {
        if (auto frame = take_or_skip(line)) return numbered(std::move(frame));
      } else {
        end_of_log();
      }
    }
  }

  double progress() const { return lines_.progress(); }
  const CarmenStatistics& statistics() const { return statistics_; }

 private:
  std::optional<Frame> numbered(std::optional<Frame> frame) {
    frame->index = frames_given_++;
    return frame;
  }

  void choose_laser(const std::string& message) {
    laser_.emplace(message, options_);
    statistics_.laser_message = message;
    if (starts_with(message, "ROBOTLASER"))
      if (const auto mount = mount_by_robotlaser(lines_.path(), message)) laser_->set_mount_by_poses(*mount);
  }

  void count(std::string_view message) {
    if (message == statistics_.laser_message) {
      ++*scan_count();
    } else {
      ++statistics_.messages[std::string(message)];
    }
  }

  // The commonest message, kept out of the search by name.
  std::size_t* scan_count() {
    if (scan_count_ == nullptr) scan_count_ = &statistics_.messages[statistics_.laser_message];
    return scan_count_;
  }

  std::optional<Frame> take_or_skip(std::string_view line) {
    try {
      return take_line(line);
    } catch (const MalformedLine& error) {
      if (!lines_.line_was_ended()) throw;
      skip(error);
      return std::nullopt;
    }
  }

  void skip(const MalformedLine& error) {
    SkippedLines& skipped = statistics_.skipped;
    if (skipped.count == 0) skipped.first = error.what();
    ++skipped.count;
    if (skipped.count > std::max(kSkippedBeforeTheEnd, lines_needed_ / kLinesForOneSkipped))
      fail_as_garbled();
  }

  /// A frame if the line is a scan with its own odometry; scans without go to the interpolator.
  std::optional<Frame> take_line(std::string_view line) {
    CarmenFields fields(line, lines_);
    const std::string_view name = fields.message();
    if (name.empty() || name.front() == '#') return std::nullopt;
    const bool is_candidate =
        !laser_ && std::find(candidates_.begin(), candidates_.end(), name) != candidates_.end();
    if (is_candidate) choose_laser(std::string(name));
    count(name);
    if (laser_ && name == laser_->message_name()) return take_scan(fields);
    if (name == "ODOM" && needs_odometry_messages()) {
      ++lines_needed_;
      const CarmenOdometryMessage odometry = read_odometry(fields);
      interpolator_.add_odometry(odometry.time_us, odometry.odom_T_robot);
    } else if (name == "PARAM" && laser_) {
      ++lines_needed_;
      laser_->take_parameter(fields);
    } else if (name == "PARAM") {
      early_parameters_.emplace_back(line);
    }
    return std::nullopt;
  }

  bool needs_odometry_messages() const { return !laser_ || starts_with(laser_->message_name(), "RAWLASER"); }

  std::optional<Frame> take_scan(CarmenFields& fields) {
    ++lines_needed_;
    take_early_parameters();
    const bool is_raw = starts_with(fields.message(), "RAWLASER");
    const bool is_robotlaser = starts_with(fields.message(), "ROBOTLASER");
    CarmenLaserMessage message = is_raw          ? read_rawlaser(fields)
                                 : is_robotlaser ? read_robotlaser(fields)
                                                 : read_flaser(fields);
    if (!is_raw && !is_robotlaser && !(message.odom_T_laser == message.odom_T_robot))
      ++statistics_.scans_with_two_poses;
    Frame frame;
    frame.time_us = message.time_us;
    frame.odom_T_robot = message.odom_T_robot;
    frame.scan = laser_->scan(std::move(message), fields);
    if (!is_raw) return frame;
    interpolator_.add_scan(std::move(frame));
    if (!interpolator_.has_odometry() && interpolator_.waiting() > OdometryInterpolator::kMaxWaiting)
      fail_without_odometry("none came with the first " + std::to_string(interpolator_.waiting()) + " scans");
    return std::nullopt;
  }

  void take_early_parameters() {
    for (const std::string& line : std::exchange(early_parameters_, {})) {
      ++lines_needed_;
      CarmenFields fields(line, lines_);
      try {
        laser_->take_parameter(fields);
      } catch (const MalformedLine& error) {  // the scan in whose line they are taken is none of it
        skip(error);
      }
    }
  }

  void end_of_log() {
    at_end_ = interpolator_.waiting() == 0;
    const bool gives_nothing = frames_given_ == 0 && (at_end_ || !interpolator_.has_odometry());
    if (gives_nothing && statistics_.skipped.count > 0) throw UserError(statistics_.skipped.first);
    if (at_end_ && statistics_.skipped.count > std::max<std::size_t>(1, lines_needed_ / kLinesForOneSkipped))
      fail_as_garbled();
    if (at_end_ && frames_given_ == 0) fail_without_scans();
    if (!at_end_ && !interpolator_.has_odometry()) fail_without_odometry("there is none");
    interpolator_.end_of_log();
  }

  [[noreturn]] void fail_as_garbled() const {
    throw UserError(lines_.path().string() + " is damaged: " + std::to_string(statistics_.skipped.count) +
                    " of its first " + std::to_string(lines_needed_) +
                    " messages do not parse, expected at most 1 %; the first is " +
                    statistics_.skipped.first);
  }

  [[noreturn]] void fail_without_odometry(const std::string& found) const {
    throw UserError(lines_.path().string() + " has no odometry: expected ODOM lines beside its " +
                    statistics_.laser_message + " lines, and " + found);
  }

  [[noreturn]] void fail_without_scans() const {
    std::string expected;
    for (const std::string& name : candidates_) expected += (expected.empty() ? "" : ", ") + name;
    std::string found;
    for (const auto& [name, lines] : statistics_.messages)
      found += (found.empty() ? "" : ", ") + std::to_string(lines) + " " + name;
    throw UserError(lines_.path().string() + " has no laser scans: expected lines of one of " + expected +
                    "; found " + (found.empty() ? "no message at all" : found));
  }

  LogOptions options_;
  std::vector<std::string> candidates_;
  LineReader lines_;
  std::optional<CarmenLaser> laser_;
  std::vector<std::string> early_parameters_;  // that came before the laser was known
  OdometryInterpolator interpolator_;
  CarmenStatistics statistics_;
  std::size_t* scan_count_ = nullptr;
  std::size_t lines_needed_ = 0;  // that were parsed, or should have been
  std::size_t frames_given_ = 0;
  bool at_end_ = false;
};

CarmenReader::CarmenReader(const std::filesystem::path& path, const LogOptions& options)
    : implementation_(std::make_unique<Implementation>(path, options)) {}

CarmenReader::~CarmenReader() = default;

std::optional<Frame> CarmenReader::next() {
  return implementation_->next();
}

double CarmenReader::progress() const {
  return implementation_->progress();
}

const CarmenStatistics& CarmenReader::statistics() const {
  return implementation_->statistics();
}

}  // namespace psi_slam
