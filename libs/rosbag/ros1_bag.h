// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 bags, version 2.0 (http://wiki.ros.org/Bags/Format/2.0): records of header fields and data, most of
// them in chunks that may be compressed (bz2, lz4). They are read from the front on; the index at the end
// only tells the topics, so that bags whose recorder was killed are read as far as they go.
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

/// The fields of a record's header, by name.
using Ros1Fields = std::map<std::string_view, std::string_view>;

/// One record of a bag, in the file or in a chunk.
struct Ros1Record {
  Ros1Fields fields;
  std::string_view data;
};

class Ros1Bag : public BagFile {
 public:
  explicit Ros1Bag(const std::filesystem::path& path);

  std::vector<BagTopic> topics() override;
  bool next(BagMessage& message) override;
  double progress() const override { return stream_.progress(); }
  std::string place() const override;

 private:
  struct Connection {
    BagTopic topic;
    bool is_wanted = true;
  };

  void read_bag_header();
  bool read_record(Ros1Record& record);
  bool read_record_of_file(Ros1Record& record);
  void open_chunk(const Ros1Record& record);
  void add_connection(const Ros1Record& record);
  bool take(const Ros1Record& record, BagMessage& message);
  bool take_message(const Ros1Record& record, BagMessage& message) const;
  void check_end() const;

  BagStream stream_;
  std::map<std::uint32_t, Connection> connections_;
  std::string header_;
  std::string chunk_;
  std::optional<ByteCursor> in_chunk_;
  std::uint64_t record_offset_ = 0;    // in the file, of the record or its chunk
  std::uint64_t offset_in_chunk_ = 0;  // of the record
  std::uint64_t index_offset_ = 0;     // where the index should begin; 0: the recorder did not close the bag
  std::uint32_t connections_told_ = 0;  // by the header, of which the index should have as many
};

}  // namespace psi_slam
