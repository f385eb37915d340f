// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_file.h"

#include <zstd.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/atomic_file.h"
#include "base/file_checksum.h"
#include "compression/compression.h"
#include "psi_slam/user_error.h"
#include "session/frame_bytes.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kMagic = "psi-slam session";
constexpr std::size_t kHeadBytes = kMagic.size() + sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
constexpr std::size_t kChecksumBytes = 64;
constexpr int kCompressionLevel = 9;
constexpr std::uint32_t kFactsOfEachLog = 3;  // the first version with the faults of every log

Json pose_json(const mrpt::math::TPose2D& pose) {
  return Json::array({pose.x, pose.y, pose.phi});
}

mrpt::math::TPose2D pose_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json json_of(const SessionFacts& facts) {
  Json logs = Json::array();
  for (const RecordedLog& log : facts.logs)
    logs.push_back({{"name", log.name},
                    {"sha256", log.sha256},
                    {"scans", log.scans},
                    {"skipped_lines",
                     {{"count", log.skipped.count},
                      {"first", log.skipped.first},
                      {"spare_scans", log.skipped.spare_scans}}},
                    {"broken_off", log.broken_off.value_or("")},
                    {"scans_left", log.scans_left}});
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

/// Damage of a log, skipped lines, and whether scans were left.
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
  }
  // Older versions have only the faults of the last log.
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
  if (!fs::exists(path, ignored)) throw UserError(path.string() + " does not exist, expected a session");
  if (fs::is_directory(path, ignored)) throw UserError(path.string() + " is a folder, expected a session");
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw UserError("cannot read " + path.string());
  return bytes;
}

/// Throws UserError unless all bytes are present and the checksum matches.
void require_whole(const fs::path& path, std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic)
    throw UserError(path.string() + " is not a session of psi-slam, expected a file of --save-session");
  if (bytes.size() < kHeadBytes + kChecksumBytes)
    throw UserError(path.string() + " is cut off: it has only " + std::to_string(bytes.size()) +
                    " bytes. Use a copy of it, or map the log again.");
  const std::size_t end = bytes.size() - kChecksumBytes;
  if (bytes.substr(end) == sha256_of_text(bytes.substr(0, end))) return;
  ByteCursor head(bytes.substr(kMagic.size() + sizeof(std::uint32_t)));
  const std::uint64_t expected = kHeadBytes + head.number<std::uint64_t>() + kChecksumBytes;
  if (bytes.size() < expected)
    throw UserError(path.string() + " is cut off: it has " + std::to_string(bytes.size()) + " of " +
                    std::to_string(expected) + " bytes. Use a copy of it, or map the log again.");
  throw UserError(path.string() +
                  " is damaged: its checksum does not match. Use a copy of it, or map the log again.");
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
    if (!is_possible(run.start.node_T_robot) || !is_possible(run.start.robot_T_found))
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
  // File names and quoted lines of logs may have any encoding.
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
                    std::to_string(kSessionVersion));
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
    throw UserError(path.string() + " is damaged: " + error.what());
  } catch (const Json::exception&) {
    throw UserError(path.string() + " is damaged: its description is not valid JSON");
  }
}

}  // namespace psi_slam
