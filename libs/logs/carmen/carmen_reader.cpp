// SPDX-License-Identifier: BSD-3-Clause
// CARMEN logs: text, one message per line; '#' starts a comment.
//
// The scans of a laser come from one kind of message. By default the front laser is read: ROBOTLASER1, else
// FLASER, else RAWLASER1, depending on the first 500 lines of the log. If these lines have none of the three,
// the rear laser is read (ROBOTLASER2, RLASER, RAWLASER2), else RAWLASER3 or RAWLASER4. If the log states
// different mounts of this laser and of others, these are read, too. The reader counts all messages, and
// ignores the scans of other lasers.
//
// A scan line states the odometry at the time of the scan, except RAWLASER lines: their odometry is
// interpolated between ODOM lines. Without ODOM lines among the first 1000 scans, RAWLASER scans have no
// odometry. FLASER lines state a second pose, which a mapper may have corrected. This second pose is never
// taken as odometry.
//
// The reader skips malformed lines if they are few: one line, or at most 1 % of the lines that it needs. It
// throws UserError if there are more malformed lines, or if the last line is truncated.
//
// A stream is looked over only for its first seconds, see open_carmen_stream(). All its malformed lines are
// skipped, because a connection may be cut at any time.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "base/text_parts.h"
#include "logs/carmen/carmen_lasers.h"
#include "logs/carmen/carmen_stream.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/look_over.h"
#include "logs/frames/odometry_interpolator.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/pose_tolerance.h"

namespace psi_slam {
namespace {

constexpr std::size_t kLinesForOneSkipped = 100;
// Number of skipped lines that are always allowed before the end of the log. Damage may be local: the
// fraction of skipped lines can fall later.
constexpr std::size_t kSkippedBeforeTheEnd = 100;

constexpr std::size_t kMostHeadBytes = std::size_t{16} * 1024 * 1024;  // of a stream
// Names of messages of a stream that the contents tell apart, besides those that are read, and their length.
constexpr std::size_t kMostOtherNames = 20;
constexpr std::size_t kMostNameLength = 32;
constexpr const char* kOtherName = "unknown";

/// Keeps a copy of the bytes that are read from another source.
class CopiedSource : public ByteSource {
 public:
  CopiedSource(ByteSource& source, std::string& copy) : source_(source), copy_(copy) {}

  std::size_t read(char* bytes, std::size_t size) override {
    const std::size_t done = source_.read(bytes, size);
    copy_.append(bytes, done);
    return done;
  }
  const std::filesystem::path& path() const override { return source_.path(); }
  double progress() const override { return source_.progress(); }

 private:
  ByteSource& source_;
  std::string& copy_;
};

/// Beginning of a stream.
class StreamHead {
 public:
  /// Reads a stream until it has been looked over, see LookOver.
  StreamHead(ByteSource& stream, const LogOptions& options, double look_over_s);

  const std::filesystem::path& name() const { return name_; }
  bool has_odometry() const { return has_odometry_; }

  /// The lines that decide what is read.
  std::string lines() const { return bytes_.substr(0, lines_end_); }

  /// All bytes that were taken from the stream: the lines, and bytes that follow them.
  const std::string& bytes() const { return bytes_; }

 private:
  void forget_old_lines();

  std::filesystem::path name_;
  std::string bytes_;
  std::size_t lines_end_ = 0;
  bool has_odometry_ = false;
};

/// Returns the time of a scan line; empty for a malformed one.
std::optional<TimeUs> time_of_scan(CarmenFields& fields) {
  try {
    return read_laser(fields).time_us;
  } catch (const MalformedLine&) {  // the reader reports this line later
    return std::nullopt;
  }
}

StreamHead::StreamHead(ByteSource& stream, const LogOptions& options, double look_over_s)
    : name_(stream.path()) {
  LineReader lines(std::make_unique<CopiedSource>(stream, bytes_));
  const bool names_several = laser_choice("log.laser", options.laser).names.size() > 1;
  auto lasers = carmen_laser_candidates(options);  // lasers without a scan so far, if several are named
  std::vector<std::string> scans;
  for (const auto& candidates : lasers) scans.insert(scans.end(), candidates.begin(), candidates.end());
  LookOver look_over(look_over_s);
  bool is_enough = false;
  std::string_view line;
  while (!is_enough && lines.next(line)) {
    lines_end_ = std::min(bytes_.find('\n', lines_end_), bytes_.size() - 1) + 1;
    CarmenFields fields(line, lines);
    const std::string name(fields.message().substr(0, kMostNameLength));
    has_odometry_ = has_odometry_ || name == "ODOM";
    if (contains(scans, name))
      if (const auto time_us = time_of_scan(fields)) {
        look_over.add_scan(*time_us);
        lasers.erase(std::remove_if(lasers.begin(), lasers.end(),
                                    [&](const auto& candidates) { return contains(candidates, name); }),
                     lasers.end());
      }
    const bool awaits_laser = names_several && !lasers.empty();
    is_enough = look_over.is_enough(awaits_laser) ||
                (look_over.began() && !awaits_laser && lines.line_number() >= kLinesOfHead);
    if (lines_end_ <= kMostHeadBytes) continue;
    is_enough = is_enough || look_over.began();
    if (!is_enough) forget_old_lines();
  }
}

/// Drops the oldest lines until half of the most bytes are left. Keeps the first PARAM lines.
void StreamHead::forget_old_lines() {
  const std::string_view bytes = bytes_;
  std::string parameters;
  std::size_t begin = 0;
  while (begin < lines_end_ && parameters.size() + lines_end_ - begin > kMostHeadBytes / 2) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size() - 1) + 1;
    const std::string_view line = bytes.substr(begin, end - begin);
    if (starts_with(line, "PARAM ") && parameters.size() + line.size() <= kMostHeadBytes / 4)
      parameters += line;
    begin = end;
  }
  lines_end_ += parameters.size() - begin;
  bytes_.replace(0, begin, parameters);
}

class CarmenReader : public LogReader {
 public:
  CarmenReader(const std::filesystem::path& path, const LogOptions& options)
      : CarmenReader(CarmenText(path), LineReader(path), options) {}

  /// Reads a stream from its beginning.
  CarmenReader(const StreamHead& head, std::unique_ptr<ByteSource> stream, const LogOptions& options)
      : CarmenReader(CarmenText(head.name(), std::make_shared<const std::string>(head.lines())),
                     LineReader(std::make_unique<TextSource>(
                         std::make_shared<const std::string>(head.bytes()), head.name(), std::move(stream))),
                     options) {
    if (!with_odometry_ || head.has_odometry()) return;
    interpolator_.expect_no_odometry();
    ignores_odom_lines_ = lasers_.any_needs_odometry();
  }

  double progress() const override { return lines_.progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    std::string_view line;
    while (true) {
      if (auto frame = interpolator_.take()) return frame;
      if (at_end_) return std::nullopt;
      if (lines_.next(line)) {
        if (auto frame = take_or_skip(line)) return frame;
      } else {
        end_of_log();
      }
    }
  }

 private:
  CarmenReader(CarmenText text, LineReader lines, const LogOptions& options)
      : is_stream_(text.is_stream()),
        lasers_(std::move(text), options),
        lines_(std::move(lines)),
        interpolator_(is_stream_ ? kMostWaitingOfStream : OdometryInterpolator::kMaxWaiting),
        with_odometry_(!ignores_odometry(options)) {
    if (!with_odometry_) interpolator_.expect_no_odometry();
    contents_.several_lasers = lasers_.several();
    contents_.laser_names = lasers_.names();
    contents_.assumptions = lasers_.assumptions();
  }

  /// Returns the name that a message is counted under. A stream may hold any number of damaged names, which
  /// share one.
  std::string counted_name(std::string_view message) {
    if (!is_stream_ || message == "ODOM" || message == "PARAM") return std::string(message);
    if (message.size() > kMostNameLength) return kOtherName;
    std::string name(message);
    if (other_names_.count(name) == 0) {
      if (other_names_.size() == kMostOtherNames) return kOtherName;
      other_names_.insert(name);
    }
    return name;
  }

  void count(std::string_view message, CarmenLasers::Laser* laser) {
    if (laser == nullptr) {
      ++contents_.messages[counted_name(message)];
      return;
    }
    scan_counts_.resize(std::max(scan_counts_.size(), laser->number + 1));
    std::size_t*& lines = scan_counts_[laser->number];
    if (lines == nullptr) {
      lines = &contents_.messages[std::string(message)];
      contents_.laser += (contents_.laser.empty() ? "" : ", ") + std::string(message);
      if (message == "FLASER" || message == "RLASER") contents_.states_beam_angles = false;
    }
    ++*lines;
  }

  std::optional<Frame> take_or_skip(std::string_view line) {
    try {
      return take_line(line);
    } catch (const MalformedLine& error) {
      if (!lines_.line_was_ended() && !is_stream_) throw;
      skip(error);
      return std::nullopt;
    }
  }

  void skip(const MalformedLine& error) {
    SkippedLines& skipped = contents_.skipped;
    if (skipped.count == 0) skipped.first = error.what();
    ++skipped.count;
    if (!is_stream_ && skipped.count > std::max(kSkippedBeforeTheEnd, lines_needed_ / kLinesForOneSkipped))
      fail_as_garbled();
  }

  /// Returns a frame if the line is a scan with its own odometry. Other scans go to the interpolator.
  std::optional<Frame> take_line(std::string_view line) {
    CarmenFields fields(line, lines_);
    const std::string_view name = fields.message();
    if (name.empty() || name.front() == '#') return std::nullopt;
    CarmenLasers::Laser* laser = lasers_.laser_of(name);
    count(name, laser);
    if (laser != nullptr) return take_scan(fields, *laser);
    if (name == "ODOM" && (!lasers_.any_known() || lasers_.any_needs_odometry())) {
      ++lines_needed_;
      if (std::exchange(ignores_odom_lines_, false))
        contents_.assumptions.push_back(
            "no ODOM line came in the first seconds, so later ones are not used. Wait longer with "
            "--look-over-s");
      const CarmenOdometryMessage odometry = read_odometry(fields);
      interpolator_.add_odometry(odometry.time_us, odometry.odom_T_robot);
    } else if (name == "PARAM") {
      take_parameter(line);
    }
    return std::nullopt;
  }

  void take_parameter(std::string_view line) {
    if (!lasers_.all_known()) lasers_.keep_parameter(line);
    if (lasers_.any_known()) ++lines_needed_;
    lasers_.for_each([&](CarmenLaser& laser) { parse_parameter(line, laser); });
  }

  void parse_parameter(std::string_view line, CarmenLaser& laser) const {
    CarmenFields fields(line, lines_);
    laser.take_parameter(fields);
  }

  std::optional<Frame> take_scan(CarmenFields& fields, CarmenLasers::Laser& laser) {
    ++lines_needed_;
    if (!std::exchange(laser.began, true)) begin(laser);
    const bool is_raw = starts_with(fields.message(), "RAWLASER");
    const bool is_robotlaser = starts_with(fields.message(), "ROBOTLASER");
    CarmenLaserMessage message = read_laser(fields);
    if (!is_raw && !is_robotlaser) compare_poses(message, laser.number);
    Frame frame;
    frame.time_us = message.time_us;
    frame.odom_T_robot = message.odom_T_robot;
    frame.scan = laser.laser.scan(std::move(message), fields);
    frame.scan.laser = laser.number;
    frame.has_odometry = with_odometry_;
    if (!is_raw) return frame;
    interpolator_.add_scan(std::move(frame));
    if (!interpolator_.has_odometry() && interpolator_.waiting() > interpolator_.most_waiting()) {
      interpolator_.expect_no_odometry();
      contents_.assumptions.push_back("no ODOM line is among the first " +
                                      std::to_string(interpolator_.waiting()) +
                                      " scans, so later ones are not used");
    }
    return std::nullopt;
  }

  /// Counts the scan if its line has a second pose. A second pose that moves with the robot is the laser's:
  /// by majority vote, most scans have it at one place on the robot.
  void compare_poses(const CarmenLaserMessage& message, std::size_t laser) {
    constexpr PoseTolerance kRounding{0.005, 0.005};
    if (!(message.odom_T_laser == message.odom_T_robot)) ++contents_.scans_with_two_poses;
    const mrpt::math::TPose2D robot_T_second = between(message.odom_T_robot, message.odom_T_laser);
    SecondPose& usual = second_poses_[laser];
    if (usual.votes == 0) usual.robot_T_second = robot_T_second;
    usual.votes += is_same_place(usual.robot_T_second, robot_T_second, kRounding) ? 1 : -1;
    contents_.second_pose_is_mapped = 2 * usual.votes < ++usual.scans;
  }

  /// Prepares a laser for its first scan: applies the PARAM lines before it. Throws UserError if several
  /// lasers are read and the mount of this laser is unknown.
  void begin(CarmenLasers::Laser& laser) {
    for (std::size_t i = 0; i < laser.early_parameters; ++i) {
      ++lines_needed_;
      try {
        parse_parameter(lasers_.parameters()[i], laser.laser);
      } catch (const MalformedLine& error) {  // a malformed parameter must not discard the scan
        skip(error);
      }
    }
    if (lasers_.several() && !laser.laser.stated_mount()) fail_without_mount(laser.laser);
    contents_.laser_names = lasers_.names();
  }

  void end_of_log() {
    at_end_ = interpolator_.waiting() == 0;
    const bool gives_nothing = frames_read() == 0 && at_end_;
    if (gives_nothing && contents_.skipped.count > 0) throw UserError(contents_.skipped.first);
    if (at_end_ && !is_stream_ &&
        contents_.skipped.count > std::max<std::size_t>(1, lines_needed_ / kLinesForOneSkipped))
      fail_as_garbled();
    if (at_end_ && frames_read() == 0) fail_without_scans();
    if (!interpolator_.has_odometry()) interpolator_.expect_no_odometry();
    interpolator_.end_of_log();
  }

  [[noreturn]] void fail_as_garbled() const {
    throw UserError(
        lines_.path().string() + " is damaged: " + std::to_string(contents_.skipped.count) +
        " of its first " + std::to_string(lines_needed_) +
        " messages do not parse, expected at most 1 %. Fetch the log again or repair it. The first one: " +
        contents_.skipped.first);
  }

  [[noreturn]] void fail_without_mount(const CarmenLaser& laser) const {
    const std::string& name = laser.message_name();
    const std::string parameter =
        laser.position().empty() ? "" : ", expected PARAM robot_" + laser.position() + "laser_offset";
    throw UserError(lines_.path().string() + " does not state where the laser of its " + name +
                    " lines is mounted, which is required to combine several lasers" + parameter +
                    ". State it with log.laser_mounts, such as \"" + name + " 0.2 0 " +
                    (laser.position() == "rear" ? "180" : "0") + "\" (metres, degrees)");
  }

  [[noreturn]] void fail_without_scans() const {
    std::vector<std::string> found;
    for (const auto& [name, lines] : contents_.messages) found.push_back(std::to_string(lines) + " " + name);
    throw UserError(lines_.path().string() + " has no laser scans, expected lines of one of " +
                    name_list(lasers_.candidates()) + "; found " +
                    (found.empty() ? std::string("no messages. Check that the ") +
                                         (is_stream_ ? "sender writes CARMEN lines" : "file is a CARMEN log")
                                   : name_list(found) + ". Select a laser with log.laser"));
  }

  bool is_stream_;
  CarmenLasers lasers_;
  LineReader lines_;
  OdometryInterpolator interpolator_;
  // Pointers into contents_.messages, by number of the laser, to avoid a search.
  std::vector<std::size_t*> scan_counts_;
  struct SecondPose {
    mrpt::math::TPose2D robot_T_second;
    int votes = 0;  // scans with this pose, minus scans with another one
    int scans = 0;
  };
  std::map<std::size_t, SecondPose> second_poses_;  // by laser
  std::set<std::string> other_names_;               // of messages of a stream that are counted, but not read
  bool with_odometry_;
  bool ignores_odom_lines_ = false;  // because the first lines of the stream had none; none has come so far
  std::size_t lines_needed_ = 0;     // number of lines needed so far, malformed ones included
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_carmen_log(const std::filesystem::path& path, const LogOptions& options) {
  return std::make_unique<CarmenReader>(path, options);
}

std::unique_ptr<LogReader> open_carmen_stream(std::unique_ptr<ByteSource> stream, const LogOptions& options,
                                              double look_over_s) {
  const StreamHead head(*stream, options, look_over_s);
  return std::make_unique<CarmenReader>(head, std::move(stream), options);
}

}  // namespace psi_slam
