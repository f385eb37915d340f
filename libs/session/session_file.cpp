// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_file.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/byte_cursor.h"
#include "base/file_checksum.h"
#include "compression/compression.h"
#include "frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;
using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic = "psi-slam session";
constexpr std::size_t kHeadBytes = kMagic.size() + sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
constexpr std::size_t kChecksumBytes = 64;
constexpr int kCompressionLevel = 9;
constexpr const char* kUseACopy = "Use a copy of it, or map the log again.";
constexpr std::uint32_t kFactsOfEachLog = 3;  // first version with the damage and skipped lines of every log

// Frames are stored in little-endian bytes, every number to the last bit.

constexpr std::uint32_t kSeveralLasers = 2;  // first version with several lasers
// Protects against damaged files, because the mapper's memory grows with it.
constexpr std::uint32_t kMostLasers = 64;

enum Flags : std::uint8_t {
  kHasOdometry = 1,
  kOtherSensor = 2,    ///< the sensor differs from the previous frame's sensor and is described
  kHasCompanions = 4,  ///< the number of companions and their scans follow
  kHasImuHeading = 8,  ///< the heading by a gyroscope follows; not before version 4
};
constexpr std::uint8_t kAllFlags = kHasOdometry | kOtherSensor | kHasCompanions | kHasImuHeading;

/// Appends the bytes of a number to `bytes`.
template <class Number>
void append_number(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof raw);
  if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__)
    for (std::size_t i = 0; i < sizeof raw / 2; ++i) std::swap(raw[i], raw[sizeof raw - 1 - i]);
  bytes.append(raw, sizeof raw);
}

void append_pose(std::string& bytes, const TPose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.phi}) append_number(bytes, value);
}

/// Reads a pose of a robot or a laser. Throws MalformedBytes for a pose that odometry cannot measure.
TPose2D read_pose(ByteCursor& bytes) {
  TPose2D pose;
  for (double* const value : {&pose.x, &pose.y, &pose.phi}) *value = bytes.number<double>();
  if (!is_possible_odometry(pose)) throw MalformedBytes("invalid pose");
  return pose;
}

void append_floats(std::string& bytes, const std::vector<float>& values) {
  append_number(bytes, static_cast<std::uint32_t>(values.size()));
  for (const float value : values) append_number(bytes, value);
}

std::vector<float> read_floats(ByteCursor& bytes) {
  const auto count = bytes.number<std::uint32_t>();
  ByteCursor raw(bytes.take(std::size_t{count} * sizeof(float)));
  std::vector<float> values(count);
  for (float& value : values) value = raw.number<float>();
  return values;
}

/// Returns the bytes of the description that all scans of one sensor share.
std::string sensor_bytes(const LaserScan& scan) {
  std::string bytes;
  append_floats(bytes, scan.bearings_rad ? *scan.bearings_rad : std::vector<float>());
  append_number(bytes, scan.max_range_m);
  append_pose(bytes, scan.robot_T_laser);
  append_number(bytes, scan.sweep_time_s);
  append_number(bytes, static_cast<std::uint32_t>(scan.laser));
  return bytes;
}

LaserScan read_sensor(ByteCursor& bytes, std::uint32_t version) {
  LaserScan sensor;
  std::vector<float> bearings_rad = read_floats(bytes);
  if (!std::all_of(bearings_rad.begin(), bearings_rad.end(), [](float rad) { return std::isfinite(rad); }))
    throw MalformedBytes("beam bearing is not finite");
  sensor.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings_rad));
  sensor.max_range_m = bytes.number<float>();
  sensor.robot_T_laser = read_pose(bytes);
  sensor.sweep_time_s = bytes.number<float>();
  if (version >= kSeveralLasers) sensor.laser = bytes.number<std::uint32_t>();
  if (sensor.laser >= kMostLasers) throw MalformedBytes("the number of a laser is too high");
  return sensor;
}

void read_ranges(ByteCursor& bytes, LaserScan& scan) {
  scan.ranges_m = read_floats(bytes);
  if (scan.ranges_m.size() != scan.bearings_rad->size())
    throw MalformedBytes("a scan has another number of beams than its sensor");
}

/// Appends a scan. Describes its sensor if the sensor differs from `last_sensor`.
void append_scan(std::string& bytes, int flags, TimeUs time_us, const TPose2D& pose, const LaserScan& scan,
                 std::string& last_sensor) {
  const std::string sensor = sensor_bytes(scan);
  const bool other = std::exchange(last_sensor, sensor) != sensor;
  append_number(bytes, static_cast<std::uint8_t>(flags | (other ? kOtherSensor : 0)));
  append_number(bytes, time_us);
  append_pose(bytes, pose);
  if (other) bytes += sensor;
  append_floats(bytes, scan.ranges_m);
}

/// The last described sensors. Key 0 is the frame's own scan, key i + 1 is companion i.
template <class Sensor>
using LastSensors = std::map<std::size_t, Sensor>;

std::vector<CompanionScan> read_companions(ByteCursor& bytes, std::uint32_t version, std::size_t first_laser,
                                           LastSensors<LaserScan>& sensors) {
  std::vector<CompanionScan> companions;
  const auto count = bytes.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    CompanionScan companion;
    const auto flags = bytes.number<std::uint8_t>();
    if ((flags & ~kOtherSensor) != 0) throw MalformedBytes("a scan has an unknown flag");
    companion.time_us = bytes.number<TimeUs>();
    companion.frame_T_robot = read_pose(bytes);
    LaserScan& sensor = sensors[i + 1];
    if (flags != 0) sensor = read_sensor(bytes, version);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan of a laser has no sensor description");
    companion.scan = sensor;
    if (sensor.laser <= (companions.empty() ? first_laser : companions.back().scan.laser))
      throw MalformedBytes("the lasers of a frame are out of order");
    read_ranges(bytes, companion.scan);
    companions.push_back(std::move(companion));
  }
  return companions;
}

void append_frames(std::string& bytes, const std::vector<Frame>& frames) {
  append_number(bytes, std::uint64_t{frames.size()});
  LastSensors<std::string> sensors;
  for (const Frame& frame : frames) {
    append_scan(bytes,
                (frame.has_odometry ? kHasOdometry : 0) | (frame.companions.empty() ? 0 : kHasCompanions) |
                    (frame.imu_heading_rad ? kHasImuHeading : 0),
                frame.time_us, frame.odom_T_robot, frame.scan, sensors[0]);
    if (frame.imu_heading_rad) append_number(bytes, *frame.imu_heading_rad);
    if (frame.companions.empty()) continue;
    append_number(bytes, static_cast<std::uint32_t>(frame.companions.size()));
    for (std::size_t i = 0; i < frame.companions.size(); ++i) {
      const CompanionScan& companion = frame.companions[i];
      append_scan(bytes, 0, companion.time_us, companion.frame_T_robot, companion.scan, sensors[i + 1]);
    }
  }
}

/// Reads the frames of a file of this `version` and numbers them from 0. Throws MalformedBytes if the bytes
/// are damaged.
std::vector<Frame> read_frames(ByteCursor& bytes, std::uint32_t version) {
  const auto count = bytes.number<std::uint64_t>();
  std::vector<Frame> frames;
  LastSensors<LaserScan> sensors;
  for (std::uint64_t i = 0; i < count; ++i) {
    Frame frame;
    frame.index = frames.size();
    const auto flags = bytes.number<std::uint8_t>();
    if ((flags & ~kAllFlags) != 0) throw MalformedBytes("a scan has an unknown flag");
    frame.has_odometry = (flags & kHasOdometry) != 0;
    frame.time_us = bytes.number<TimeUs>();
    frame.odom_T_robot = read_pose(bytes);
    LaserScan& sensor = sensors[0];
    if ((flags & kOtherSensor) != 0) sensor = read_sensor(bytes, version);
    if (!sensor.bearings_rad) throw MalformedBytes("the first scan has no sensor description");
    frame.scan = sensor;
    read_ranges(bytes, frame.scan);
    if ((flags & kHasImuHeading) != 0) frame.imu_heading_rad = bytes.number<double>();
    if (!std::isfinite(frame.imu_heading_rad.value_or(0)))
      throw MalformedBytes("the heading by a gyroscope is not finite");
    if ((flags & kHasCompanions) != 0)
      frame.companions = read_companions(bytes, version, frame.scan.laser, sensors);
    frames.push_back(std::move(frame));
  }
  return frames;
}

Json pose_json(const TPose2D& pose) {
  return Json::array({pose.x, pose.y, pose.phi});
}

TPose2D pose_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json json_of(const LogCalibration& calibration) {
  Json estimates = Json::array();
  for (const CalibratedOption& estimate : calibration.estimates)
    estimates.push_back({{"log", estimate.log},
                         {"laser", estimate.laser},
                         {"option", estimate.option},
                         {"value", estimate.value},
                         {"deviation", estimate.deviation},
                         {"is_used", estimate.is_used}});
  return {{"estimates", estimates}, {"sentences", calibration.sentences}};
}

LogCalibration calibration_of(const Json& json) {
  LogCalibration calibration;
  for (const Json& estimate : json.at("estimates"))
    calibration.estimates.push_back(
        {estimate.at("log").get<std::string>(), estimate.at("laser").get<std::string>(),
         estimate.at("option").get<std::string>(), estimate.at("value").get<double>(),
         estimate.at("deviation").get<double>(), estimate.at("is_used").get<bool>()});
  calibration.sentences = json.at("sentences").get<std::vector<std::string>>();
  return calibration;
}

Json json_of(const SessionFacts& facts) {
  Json logs = Json::array();
  for (const RecordedLog& log : facts.logs) {
    logs.push_back({{"name", log.name},
                    {"sha256", log.sha256},
                    {"scans", log.scans},
                    {"skipped_lines",
                     {{"count", log.skipped.count},
                      {"first", log.skipped.first},
                      {"spare_scans", log.skipped.spare_scans}}},
                    {"broken_off", log.broken_off.value_or("")},
                    {"scans_left", log.scans_left}});
    if (log.calibration) logs.back()["calibration"] = json_of(*log.calibration);
  }
  Json runs = Json::array();
  for (const RecordedRun& run : facts.runs) {
    runs.push_back({{"scan", run.scan},
                    {"node", run.start.node},
                    {"node_T_robot", pose_json(run.start.node_T_robot)},
                    {"robot_T_found", pose_json(run.start.robot_T_found)}});
  }
  return {{"program_version", facts.program_version},
          {"logs", logs},
          {"drives", runs},
          {"settings", facts.settings},
          {"edits", facts.edits.text()}};
}

/// Reads the damage of a log, its skipped lines, and whether scans were left unread.
void read_faults(const Json& json, std::uint32_t version, RecordedLog& log) {
  const Json& skipped = json.at("skipped_lines");
  log.skipped = {skipped.at("count").get<std::size_t>(), skipped.at("first").get<std::string>()};
  if (version >= kFactsOfEachLog) log.skipped.spare_scans = skipped.at("spare_scans").get<std::size_t>();
  if (const auto broken_off = json.at("broken_off").get<std::string>(); !broken_off.empty())
    log.broken_off = broken_off;
  log.scans_left = json.at("scans_left").get<bool>();
}

SessionFacts facts_of(const Json& json, std::uint32_t version, const fs::path& path) {
  SessionFacts facts;
  facts.program_version = json.at("program_version").get<std::string>();
  for (const Json& log : json.at("logs")) {
    facts.logs.push_back({log.at("name").get<std::string>(), log.at("sha256").get<std::string>(),
                          log.at("scans").get<std::size_t>()});
    if (version >= kFactsOfEachLog) read_faults(log, version, facts.logs.back());
    if (log.contains("calibration")) facts.logs.back().calibration = calibration_of(log.at("calibration"));
  }
  // Older versions have these facts only for the last log.
  if (version < kFactsOfEachLog && !facts.logs.empty()) read_faults(json, version, facts.logs.back());
  for (const Json& run : json.at("drives"))
    facts.runs.push_back({run.at("scan").get<std::size_t>(),
                          {run.at("node").get<std::size_t>(), pose_of(run.at("node_T_robot")),
                           pose_of(run.at("robot_T_found"))}});
  facts.settings = json.at("settings").get<std::string>();
  facts.edits = EditJournal::parse(json.at("edits").get<std::string>(), path);
  return facts;
}

std::string packed(const std::string& bytes) {
  std::string room(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t used =
      ZSTD_compress(room.data(), room.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(used) != 0) throw SystemFailure("cannot compress the session: out of memory");
  room.resize(used);
  return room;
}

std::string all_bytes(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw UserError(path.string() + " does not exist, expected a session. Check the path");
  if (fs::is_directory(path, ignored))
    throw UserError(path.string() + " is a folder, expected a session. Check the path");
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw UserError("cannot read " + path.string() + ", expected a session. Check its permissions");
  return bytes;
}

/// Throws UserError unless all bytes are present and the checksum matches.
void require_whole(const fs::path& path, std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic)
    throw UserError(path.string() +
                    " is not a session of psi-slam, expected a file of --save-session. Choose another file");
  if (bytes.size() < kHeadBytes + kChecksumBytes)
    throw UserError(path.string() + " is cut off: it has only " + std::to_string(bytes.size()) + " bytes. " +
                    kUseACopy);
  const std::size_t end = bytes.size() - kChecksumBytes;
  if (bytes.substr(end) == sha256_of_text(bytes.substr(0, end))) return;
  ByteCursor head(bytes.substr(kMagic.size() + sizeof(std::uint32_t)));
  const std::uint64_t expected = kHeadBytes + head.number<std::uint64_t>() + kChecksumBytes;
  if (bytes.size() < expected)
    throw UserError(path.string() + " is cut off: it has " + std::to_string(bytes.size()) + " of " +
                    std::to_string(expected) + " bytes. " + kUseACopy);
  throw UserError(path.string() + " is damaged: its checksum does not match. " + kUseACopy);
}

void require_consistent(const SessionRecording& recording) {
  std::size_t scans = 0;
  for (const RecordedLog& log : recording.facts.logs) {
    if (log.scans > recording.frames.size()) throw MalformedBytes("a log has more scans than the session");
    scans += log.scans;
  }
  if (scans != recording.frames.size() || recording.facts.logs.empty())
    throw MalformedBytes("the scans of its logs do not add up");
  std::size_t begin = 0;
  for (const RecordedRun& run : recording.facts.runs) {
    if (run.scan >= recording.frames.size()) throw MalformedBytes("a run begins after the last scan");
    if (!is_possible_odometry(run.start.node_T_robot) || !is_possible_odometry(run.start.robot_T_found))
      throw MalformedBytes("a run begins at an invalid pose");
    if (run.scan <= begin) throw MalformedBytes("its runs are out of order");
    begin = run.scan;
  }
}

}  // namespace

bool is_session_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(kMagic.size(), '\0');
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kMagic;
}

void write_session_file(const fs::path& path, const SessionFacts& facts, const std::vector<Frame>& frames) {
  std::string content;
  // Replaces invalid UTF-8: file names and quoted lines of logs may have any encoding.
  const std::string json = json_of(facts).dump(-1, ' ', false, Json::error_handler_t::replace);
  append_number(content, std::uint64_t{json.size()});
  content += json;
  append_frames(content, frames);
  const std::string compressed = packed(content);
  std::string bytes(kMagic);
  append_number(bytes, kSessionVersion);
  append_number(bytes, std::uint64_t{compressed.size()});
  append_number(bytes, std::uint64_t{content.size()});
  bytes += compressed;
  bytes += sha256_of_text(bytes);
  write_text_atomically(path, bytes);
}

SessionRecording read_session_file(const fs::path& path) {
  const std::string bytes = all_bytes(path);
  require_whole(path, bytes);
  ByteCursor head(std::string_view(bytes).substr(kMagic.size()));
  const auto version = head.number<std::uint32_t>();
  if (version == 0 || version > kSessionVersion)
    throw UserError(path.string() + " is a session of version " + std::to_string(version) +
                    ", made by a newer psi-slam. This one reads versions up to " +
                    std::to_string(kSessionVersion) + ". Install the newer psi-slam");
  try {
    const auto packed_size = head.number<std::uint64_t>();
    const auto size = head.number<std::uint64_t>();
    const std::string content = decompress("zstd", head.take(packed_size), size);
    ByteCursor cursor(content);
    const std::string_view json = cursor.take(cursor.number<std::uint64_t>());
    SessionRecording recording;
    recording.facts = facts_of(Json::parse(json), version, path);
    recording.frames = read_frames(cursor, version);
    if (!cursor.at_end()) throw MalformedBytes("there are bytes after its last scan");
    require_consistent(recording);
    return recording;
  } catch (const MalformedBytes& error) {
    throw UserError(path.string() + " is damaged: " + error.what() + ". " + kUseACopy);
  } catch (const Json::exception&) {
    throw UserError(path.string() + " is damaged: its description is not valid JSON. " + kUseACopy);
  }
}

}  // namespace psi_slam
