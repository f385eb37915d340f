// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_content.h"

#include <zstd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/compression/compression.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;
using Json = nlohmann::ordered_json;

// Sessions of real logs unpack to less than 10 times their size. A small file may unpack to more.
constexpr std::uint64_t kMostMemoryPerByte = 64;
constexpr std::uint64_t kMemoryOfAnySession = std::uint64_t{1} << 28;
constexpr std::uint64_t kMostBytesOfFacts = std::uint64_t{1}
                                            << 24;  // JSON takes much more memory than its text

Json pose_json(const TPose2D& pose) {
  return Json::array({pose.x, pose.y, pose.phi});
}

TPose2D pose_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json json_of(const LogCalibration& calibration) {
  Json estimates = Json::array();
  for (const CalibratedOption& estimate : calibration.estimates) {
    estimates.push_back({{"log", estimate.log},
                         {"laser", estimate.laser},
                         {"option", estimate.option},
                         {"value", estimate.value},
                         {"deviation", estimate.deviation},
                         {"is_used", estimate.is_used}});
    if (estimate.is_fault) estimates.back()["is_fault"] = true;
  }
  return {{"estimates", estimates}, {"sentences", calibration.sentences}};
}

LogCalibration calibration_of(const Json& json) {
  LogCalibration calibration;
  for (const Json& estimate : json.at("estimates"))
    calibration.estimates.push_back(
        {estimate.at("log").get<std::string>(), estimate.at("laser").get<std::string>(),
         estimate.at("option").get<std::string>(), estimate.at("value").get<double>(),
         estimate.at("deviation").get<double>(), estimate.at("is_used").get<bool>(),
         estimate.value("is_fault", false)});
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
    if (!log.assumptions.empty()) logs.back()["assumptions"] = log.assumptions;
  }
  Json runs = Json::array();
  for (const RecordedRun& run : facts.runs) {
    runs.push_back({{"scan", run.scan},
                    {"node", run.start.node},
                    {"node_T_robot", pose_json(run.start.node_T_robot)},
                    {"robot_T_found", pose_json(run.start.robot_T_found)}});
  }
  Json json{{"program_version", facts.program_version},
            {"logs", logs},
            {"drives", runs},
            {"settings", facts.settings},
            {"edits", facts.edits.text()}};
  if (facts.prior) json["prior"] = {{"map", facts.prior->map}, {"sha256", facts.prior->sha256}};
  return json;
}

/// Reads the damage of a log, its skipped lines, and whether scans were left unread.
void read_faults(const Json& json, RecordedLog& log) {
  const Json& skipped = json.at("skipped_lines");
  log.skipped = {skipped.at("count").get<std::size_t>(), skipped.at("first").get<std::string>(),
                 skipped.at("spare_scans").get<std::size_t>()};
  if (const auto broken_off = json.at("broken_off").get<std::string>(); !broken_off.empty())
    log.broken_off = broken_off;
  log.scans_left = json.at("scans_left").get<bool>();
}

SessionFacts facts_of(const Json& json, const fs::path& path) {
  SessionFacts facts;
  facts.program_version = json.at("program_version").get<std::string>();
  for (const Json& log : json.at("logs")) {
    facts.logs.push_back({log.at("name").get<std::string>(), log.at("sha256").get<std::string>(),
                          log.at("scans").get<std::size_t>()});
    read_faults(log, facts.logs.back());
    if (log.contains("calibration")) facts.logs.back().calibration = calibration_of(log.at("calibration"));
    facts.logs.back().assumptions = log.value("assumptions", std::vector<std::string>());
  }
  for (const Json& run : json.at("drives"))
    facts.runs.push_back({run.at("scan").get<std::size_t>(),
                          {run.at("node").get<std::size_t>(), pose_of(run.at("node_T_robot")),
                           pose_of(run.at("robot_T_found"))}});
  facts.settings = json.at("settings").get<std::string>();
  facts.edits = EditJournal::parse(json.at("edits").get<std::string>(), path);
  if (json.contains("prior")) {
    const Json& prior = json.at("prior");
    facts.prior = RecordedPrior{prior.at("map").get<std::string>(), prior.at("sha256").get<std::string>()};
  }
  return facts;
}

std::string compressed(const std::string& bytes, int level) {
  std::string room(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t used = ZSTD_compress(room.data(), room.size(), bytes.data(), bytes.size(), level);
  if (ZSTD_isError(used) != 0) throw SystemFailure("cannot compress the session: out of memory");
  room.resize(used);
  return room;
}

}  // namespace

void require_known_version(std::uint32_t version, const fs::path& path) {
  if (version >= kOldestSessionVersion && version <= kSessionVersion) return;
  if (version < kOldestSessionVersion)
    throw UserError(path.string() + " is a session of version " + std::to_string(version) +
                    ", made by a psi-slam before 0.1.0. This one reads versions from " +
                    std::to_string(kOldestSessionVersion) + " on. Map the log again");
  throw UserError(path.string() + " is a session of version " + std::to_string(version) +
                  ", made by a newer psi-slam. This one reads versions up to " +
                  std::to_string(kSessionVersion) + ". Install the newer psi-slam");
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

std::string facts_text(const SessionFacts& facts) {
  // Replaces invalid UTF-8: file names and quoted lines of logs may have any encoding.
  return json_of(facts).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string SessionContentWriter::packed(const std::string& facts, const std::vector<Frame>& frames,
                                         int level) {
  std::string content;
  append_number(content, std::uint64_t{facts.size()});
  content += facts;
  append_number(content, std::uint64_t{frames.size()});
  for (const Frame& frame : frames) frames_.append(content, frame);
  const std::string small = compressed(content, level);
  std::string bytes;
  append_number(bytes, std::uint64_t{small.size()});
  append_number(bytes, std::uint64_t{content.size()});
  return bytes += small;
}

SessionContentReader::SessionContentReader(fs::path path, std::size_t file_bytes)
    : path_(std::move(path)), most_memory_bytes_(kMemoryOfAnySession + kMostMemoryPerByte * file_bytes) {}

void SessionContentReader::count_memory(std::uint64_t bytes) {
  memory_bytes_ += std::min(bytes, most_memory_bytes_ + 1);
  if (memory_bytes_ > most_memory_bytes_)
    throw MalformedBytes("it unpacks to more than " + std::to_string(most_memory_bytes_) +
                         " bytes, which no session of its size needs");
}

void SessionContentReader::add(ByteCursor& packed, SessionRecording& recording) {
  const auto packed_size = packed.number<std::uint64_t>();
  const auto size = packed.number<std::uint64_t>();
  count_memory(size);
  const std::string content = decompress("zstd", packed.take(packed_size), size);
  ByteCursor bytes(content);
  const auto size_of_facts = bytes.number<std::uint64_t>();
  if (size_of_facts > kMostBytesOfFacts)
    throw MalformedBytes("its description has " + std::to_string(size_of_facts) +
                         " bytes, expected at most " + std::to_string(kMostBytesOfFacts));
  const std::string_view facts = bytes.take(size_of_facts);
  try {
    if (!facts.empty()) recording.facts = facts_of(Json::parse(facts), path_);
  } catch (const Json::exception&) {
    throw MalformedBytes("its description is not valid JSON");
  }
  const auto count = bytes.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    Frame frame = frames_.read(bytes);
    count_memory(sizeof(Frame) + frame.companions.size() * sizeof(CompanionScan));
    frame.index = recording.frames.size();
    recording.frames.push_back(std::move(frame));
  }
  if (!bytes.at_end()) throw MalformedBytes("there are bytes after its last scan");
}

}  // namespace psi_slam
