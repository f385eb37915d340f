// SPDX-License-Identifier: BSD-3-Clause
// Writes the seeds of the fuzz targets: make_fuzz_seeds FOLDER. They are small valid files, from the writers
// that the tests use.
#include <cstdio>
#include <filesystem>
#include <string>

#include "../session/room_log.h"
#include "../session/small_recording.h"
#include "bag_files.h"
#include "map/exports/map_files.h"
#include "map/exports/map_server_pair.h"
#include "rawlog_files.h"
#include "ros1_files.h"
#include "session/frame_bytes.h"
#include "session/journal_chunks.h"
#include "session/session_content.h"
#include "session/session_file.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

Recording cloud_recording() {
  Recording recording = recorded_run(1);
  recording.emplace_back(RecordedCloud{
      "/points", 1'600'000'000'010'000, "laser", {{1, 0, 0}, {0, 2, 0}, {-1, 1, 0}, {2, 2, 0}}, 2});
  recording.emplace_back(RecordedImu{"/imu", 1'600'000'000'012'000, "laser", {0, 0, 0.1}});
  return recording;
}

void write_carmen_seeds(const fs::path& folder) {
  std::string text = "PARAM laser_front_laser_resolution 1\nODOM 0 0 0 0 0 0 1 host 1\n";
  for (int scan = 0; scan < 3; ++scan)
    text += "FLASER 3 1.5 2.25 81.83 " + std::to_string(0.1 * scan) + " 0 0.1 " + std::to_string(0.1 * scan) +
            " 0 0.1 " + std::to_string(976052905 + scan) + ".25 host " + std::to_string(scan) + "\n";
  write_file(folder / "seed-flaser", text);
  write_file(
      folder / "seed-robotlaser",
      "ROBOTLASER1 0 -1.5708 3.1416 1.5708 30 0.01 0 3 1 2 3 0 0 0 0 0 0 0 0 0 0 0 0 976052905.1 host 1\n");
  write_carmen(folder / "seed-rawlaser", recorded_run(3));
  write_gzipped(folder / "seed-gzip", text);
  write_file(folder / "seed-zstd", zstd_frame(text));
}

/// The target reads the number of pages of 512 bytes of the database from the first byte. The pages and the
/// write-ahead log follow.
void write_growing_bag_seeds(const fs::path& folder) {
  const TemporaryFolder bags;
  const fs::path database = bags.path() / "run_0.db3";
  const auto write = [&](const std::string& name, const std::vector<std::string>& pragmas) {
    std::vector<std::string> all{"page_size=512"};
    all.insert(all.end(), pragmas.begin(), pragmas.end());
    Db3Writer writer(database, all);
    writer.create_tables();
    for (const Recorded& message : recorded_run(2)) writer.add(message, cdr(message));
    const std::string pages = read_file(database);
    const fs::path log = database.string() + "-wal";
    write_file(folder / name, static_cast<char>(pages.size() / 512) + pages +
                                  (fs::exists(log) ? read_file(log) : std::string()));
  };
  write("seed-plain", {});
  write("seed-log", {"journal_mode=WAL"});
  write("seed-checkpoints", {"journal_mode=WAL", "wal_autocheckpoint=7"});
}

void write_bag_seeds(const fs::path& folder) {
  for (const char* compression : {"none", "lz4", "bz2"})
    write_ros1_bag(folder / "ros1_bag" / (std::string("seed-") + compression), recorded_run(3),
                   {compression, 4, true});
  write_ros1_bag(folder / "ros1_bag" / "seed-cloud", cloud_recording(), {"none", 4, true});
  for (const char* compression : {"", "lz4", "zstd"})
    write_mcap(folder / "mcap_bag" / (std::string("seed-chunks-") + compression), recorded_run(3),
               {compression, 4, true, true});
  write_mcap(folder / "mcap_bag" / "seed-cloud", cloud_recording(), {"", 0, false, true});
  write_db3(folder / "sqlite_bag" / "seed-plain", recorded_run(2));
  write_file(folder / "sqlite_bag" / "seed-zstd",
             zstd_frame(read_file(folder / "sqlite_bag" / "seed-plain")));
  write_growing_bag_seeds(folder / "growing_sqlite_bag");
  write_file(
      folder / "bag_folder" / "seed",
      "rosbag2_bagfile_information:\n  version: 4\n  storage_identifier: mcap\n  relative_file_paths:\n"
      "    - run_0.mcap\n    - run_1.mcap\n");
}

/// The targets read the type of a message from bits 1 to 3 of the first byte, and its encoding from bit 0.
void write_message_seeds(const fs::path& folder) {
  RecordedScan echoes;
  echoes.multi_echo = true;
  const RecordedPose pose{"/odom", 1'600'000'000'000'000, "odom", "base_link", {1, 2, 0, 0.5, 0, 0}};
  const std::vector<Recorded> messages{
      RecordedScan{}, echoes, cloud_recording()[cloud_recording().size() - 2],
      RecordedImu{},  pose,   static_mount()};
  for (std::size_t i = 0; i < messages.size(); ++i)
    for (const bool is_cdr : {false, true})
      write_file(folder / ("seed-" + std::to_string(i) + (is_cdr ? "-cdr" : "-ros1")),
                 static_cast<char>(2 * i + (is_cdr ? 1 : 0)) +
                     (is_cdr ? cdr(messages[i]) : ros1_message(messages[i])));
}

void write_rawlog_seeds(const fs::path& folder) {
  RawlogObjects objects;
  for (int i = 0; i < 3; ++i) {
    const TimeUs time_us = 1'600'000'000'000'000 + 200'000 * i;
    objects.push_back(odometry(time_us, mrpt::poses::CPose2D(0.1 * i, 0, 0)));
    objects.push_back(range_scan(time_us, "LASER", std::vector<float>{1, 2, 3, 2, 1}));
  }
  write_rawlog(folder / "seed-observations", objects, false);
  write_rawlog(folder / "seed-gzip", objects, true);
  write_rawlog(folder / "seed-actions", {movement(mrpt::poses::CPose2D(0.1, 0, 0))}, false);
}

void write_session_seeds(const fs::path& folder) {
  const SessionRecording recording = small_recording();
  write_session_file(folder / "seed-file", recording.facts, recording.frames);
  write_file(folder / "seed-journal", JournalChunks().next(recording.facts, recording.frames));
  const std::string facts = facts_text(recording.facts);
  std::string content(1, static_cast<char>(kSessionVersion));
  append_number(content, std::uint64_t{facts.size()});
  content += facts;
  append_number(content, std::uint64_t{recording.frames.size()});
  FrameWriter frames;
  for (const Frame& frame : recording.frames) frames.append(content, frame);
  write_file(folder / "seed-content", content);
  write_file(folder.parent_path() / "edits" / "seed-recorded", recording.facts.edits.text());
}

void write_map_seeds(const fs::path& folder) {
  mrpt::maps::COccupancyGridMap2D grid(-0.5F, 0.5F, 0, 0.5F, 0.05F);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 20; ++x) grid.setCell(x, y, x == 7 ? 0.02F : 0.97F);
  write_mrpt_map(folder / "gridmap" / "seed-gzip", grid);
  const fs::path yaml = folder / "map_yaml" / "map.yaml";
  write_map_server_pair(yaml, grid);
  const fs::path image = folder / "map_yaml" / "map.pgm";
  write_file(folder / "map_yaml" / "seed", read_file(yaml) + '\0' + read_file(image));
  fs::remove(yaml);
  fs::remove(image);
}

void write_text_seeds(const fs::path& folder) {
  write_file(folder / "edits" / "seed-lines",
             "accept from=12 to=3 after=40\n"
             "erase polygon=1,2;3,2;3,4.5 frame=2.5,0,90\n"
             "pose time_s=1700000000.5 x_m=1 y_m=2 yaw_deg=90 sigma_m=0.02 sigma_deg=1\n"
             "tag name=A x_m=4 y_m=5 sigma_m=0.02\n"
             "seen name=A time_s=1700000012 ahead_m=1.5 left_m=-0.2 sigma_m=0.03\n");
  write_file(
      folder / "ini" / "seed",
      "[log]\nodometry = auto // comment\n; comment\n[map]\nresolution_m = 0.05\n@include \"other.ini\"\n");
  write_file(folder / "g2o" / "seed",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0.5\nFIX 0\nEDGE_SE2 0 1 1 0 0.5 100 0 0 100 0 400\n"
             "EDGE_SE2_XY 0 1 1 0 100 0 100\n");
  write_file(folder / "relations" / "seed",
             "976052905.1 976052910.2 1.5 0.25 0 0 0 0.5\n# comment\n976052905.1 976052911 2 0 0 0 0 -3.1\n");
  write_file(
      folder / "trajectory" / "seed-tum",
      "# timestamp tx ty tz qx qy qz qw\n976052905.1 1 2 0 0 0 0.5 0.8660254\n976052905.2 1 2 0 0 0 0 1\n");
  write_file(folder / "trajectory" / "seed-csv",
             "time_s,x_m,y_m,yaw_rad\n976052905.1,1,2,0.5\n976052905.2,1,2.1,0.5\n");
  write_file(folder / "trajectory" / "seed-carmen",
             "FLASER 0 1 2 0.5 1 2 0.5 976052905.1 host 1\nFLASER 0 1 2 0.5 1 2 0.5 976052906.1 host 2\n");
}

}  // namespace
}  // namespace psi_slam

int main(int count, char** words) {
  using namespace psi_slam;
  if (count != 2) {
    std::fputs("usage: make_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const fs::path folder = words[1];
  for (const char* name : {"carmen", "rawlog", "ros1_bag", "mcap_bag", "sqlite_bag", "bag_folder",
                           "ros_messages", "live_stream", "growing_sqlite_bag", "session", "edits", "ini",
                           "g2o", "relations", "trajectory", "map_yaml", "gridmap"})
    fs::create_directories(folder / name);
  write_carmen_seeds(folder / "carmen");
  write_bag_seeds(folder);
  write_message_seeds(folder / "ros_messages");
  write_rawlog_seeds(folder / "rawlog");
  write_session_seeds(folder / "session");
  write_map_seeds(folder);
  write_text_seeds(folder);
  write_file(folder / "live_stream" / "seed-lines", '\0' + read_file(folder / "carmen" / "seed-flaser"));
  write_file(folder / "live_stream" / "seed-ros1", '\1' + read_file(folder / "ros1_bag" / "seed-none"));
  write_file(folder / "live_stream" / "seed-mcap", '\1' + read_file(folder / "mcap_bag" / "seed-cloud"));
  return 0;
}
