// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 bags in MCAP files (https://mcap.dev/spec): records of one byte of kind and eight of length, the
// messages of most files in chunks that may be compressed (lz4, zstd). They are read from the front on; the
// summary at the end only tells the topics. Messages of ROS 1 in such a file are read, too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rosbag/bag_file.h"
#include "rosbag/bag_stream.h"
#include "base/byte_cursor.h"

namespace psi_slam {

/// The channels that records have told of so far; a channel's type is the name of its schema.
class McapChannels {
 public:
  void add_schema(ByteCursor record);
  void add_channel(ByteCursor record);

  /// None when nothing told of it.
  const BagTopic* topic(std::uint16_t channel) const;
  std::vector<BagTopic> topics() const;

 private:
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, BagTopic> channels_;
};

class McapBag : public BagFile {
 public:
  explicit McapBag(const std::filesystem::path& path);

  std::vector<BagTopic> topics() override;
  bool next(BagMessage& message) override;
  double progress() const override { return stream_.progress(); }
  std::string place() const override;

 private:
  struct Record {
    std::uint8_t kind = 0;
    std::string_view bytes;
  };

  bool read_record(Record& record);
  bool take(const Record& record, BagMessage& message);
  bool take_message(ByteCursor cursor, BagMessage& message) const;
  void open_chunk(ByteCursor cursor);
  std::vector<BagTopic> topics_of_summary() const;

  BagStream stream_;
  McapChannels channels_;
  std::string chunk_;
  std::optional<ByteCursor> in_chunk_;
  std::uint64_t record_offset_ = 0;    // in the file, of the record or its chunk
  std::uint64_t offset_in_chunk_ = 0;  // of the record
  bool at_end_ = false;
};

}  // namespace psi_slam
