// SPDX-License-Identifier: BSD-3-Clause
// Writes what a live run receives from ROS 2 as a bag that `ros2 bag`, Foxglove and open_mcap_bag() read:
// an MCAP file (https://mcap.dev/spec) of profile "ros2", in chunks compressed by zstd, with an index.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/appended_file.h"
#include "logs/rosbag/bag_file.h"

namespace psi_slam {

/// Writes messages to an MCAP file. The file grows by a chunk after each second of messages, or about 1 MiB
/// of them, so that a run that is killed loses only the last second. The file of such a run has no summary,
/// and is read from its beginning up to the last complete chunk. A thread of the file waits for the disk, see
/// AppendedFile.
class McapWriter {
 public:
  /// Creates the file. Throws UserError if it exists and `overwrite` is false, and SystemFailure if it cannot
  /// be created.
  explicit McapWriter(std::filesystem::path path, bool overwrite = false);
  /// Closes the file.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a message of ROS 2, in CDR. Its time of publication is the time at which it was recorded. Messages
  /// may come in any order of their times. Does nothing after close(). Throws SystemFailure if memory runs
  /// out, and nothing because of the disk.
  void add(const BagMessage& message);

  /// Writes the last chunk and the summary, trying once. Afterwards, failure() says whether the disk has
  /// them.
  void close();

  /// Why the file could not be written the last time, a sentence without full stop; empty if it was written.
  /// psi-slam tries again every second. May be called by any thread.
  std::optional<std::string> failure() const { return file_.failure(); }

  /// Number of messages that are missing in the file, because it could not be written for so long that no
  /// more of them could wait in memory. Call it in the thread that adds messages.
  std::uint64_t lost_messages() const { return lost_messages_; }

 private:
  using TimeNs = std::uint64_t;
  using ChannelId = std::uint16_t;

  /// Messages of one topic. Its number is its place in channels_, from 1.
  struct Channel {
    std::string topic;
    std::uint16_t schema = 0;         ///< number of its type
    std::uint32_t sequence = 0;       ///< sequence number of the next message
    std::uint64_t message_count = 0;  ///< messages in complete chunks
    bool is_stated = false;           ///< whether a chunk states the channel and its schema
  };

  /// Earliest and latest time of messages.
  struct TimeSpan {
    TimeNs first = std::numeric_limits<TimeNs>::max();
    TimeNs last = 0;
    void include(TimeNs time) {
      first = std::min(first, time);
      last = std::max(last, time);
    }
  };

  /// The records of the chunk that is being filled.
  struct Chunk {
    std::string records;
    TimeSpan times;
    std::map<ChannelId, std::string> index;  ///< of each channel: pairs of a time and an offset in `records`
  };

  bool append(const std::string& bytes);
  ChannelId stated_channel(const BagTopic& topic);
  ChannelId channel_of(const BagTopic& topic);
  std::uint16_t schema_of(const std::string& type);
  std::string schema_record(std::uint16_t id) const;
  std::string channel_record(ChannelId id) const;
  void end_chunk();
  void count_messages(const Chunk& chunk);
  void lose_messages(const Chunk& chunk);
  std::string statistics() const;
  std::string summary() const;

  AppendedFile file_;
  std::uint64_t file_bytes_ = 0;      ///< bytes appended to the file
  std::vector<std::string> schemas_;  ///< types; the number of a schema is its place, from 1
  std::vector<Channel> channels_;
  Chunk chunk_;
  std::string chunk_indexes_;  ///< records of the summary
  std::uint32_t chunk_count_ = 0;
  TimeSpan times_;  ///< of the complete chunks
  std::uint64_t lost_messages_ = 0;
  bool is_closed_ = false;
};

}  // namespace psi_slam
