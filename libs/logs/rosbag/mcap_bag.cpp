// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "base/compression/compression.h"
#include "logs/rosbag/mcap_records.h"
#include "logs/rosbag/record_bag.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::int64_t kFooterBytes = 1 + 8 + 20 + 8;  // including the magic bytes after the footer

std::string_view text(ByteCursor& cursor) {
  return cursor.take(cursor.number<std::uint32_t>());
}

BagEncoding encoding_named(std::string_view name) {
  if (name == "cdr") return BagEncoding::kCdr;
  return name == "ros1" ? BagEncoding::kRos1 : BagEncoding::kOther;
}

/// Channels of the records read so far. The type of a channel is the name of its schema.
class Channels {
 public:
  void add_schema(ByteCursor record) {
    const auto id = record.number<std::uint16_t>();
    schemas_[id] = ros1_type_name(text(record));
  }

  void add_channel(ByteCursor record) {
    const auto id = record.number<std::uint16_t>();
    const auto schema_id = record.number<std::uint16_t>();
    const auto schema = schemas_.find(schema_id);
    if (schema_id != 0 && schema == schemas_.end()) return;  // lost; the summary may have it
    BagTopic topic;
    topic.name = text(record);
    topic.encoding = encoding_named(text(record));
    topic.number = id;
    if (schema != schemas_.end()) topic.type = schema->second;
    channels_.emplace(id, std::move(topic));
  }

  void add(const Channels& others) { channels_.insert(others.channels_.begin(), others.channels_.end()); }

  /// Returns the topic of a channel, or null for an unknown channel.
  const BagTopic* topic(std::uint16_t channel) const {
    const auto found = channels_.find(channel);
    return found == channels_.end() ? nullptr : &found->second;
  }

  std::vector<BagTopic> topics() const {
    std::vector<BagTopic> topics;
    for (const auto& [id, topic] : channels_) add_topic(topics, topic);
    return topics;
  }

 private:
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, BagTopic> channels_;
};

class McapBag : public RecordBag {
 public:
  explicit McapBag(BagStream stream) : RecordBag(std::move(stream)) {
    if (stream_.read_up_to(mcap::kMagic.size()) != mcap::kMagic)
      throw UserError(
          stream_.path().string() +
          " is not an MCAP file of version 0, the only version that is read. Record the bag again");
  }

  std::vector<BagTopic> topics() override {
    if (auto topics = channels_of_summary().topics(); !topics.empty()) return topics;
    McapBag whole{BagStream(stream_.path())};
    const std::optional<UserError> failure = whole.read_to_end();
    std::vector<BagTopic> topics = whole.channels_.topics();
    if (failure && topics.empty() && !stream_.is_growing()) throw UserError(*failure);
    return topics;
  }

 protected:
  bool read_record_of_file() override {
    if (at_end_) return false;
    record_offset_ = stream_.offset();
    ByteCursor head(stream_.read(9));
    kind_ = head.number<std::uint8_t>();
    const auto size = head.number<std::uint64_t>();
    at_end_ = kind_ == mcap::kDataEnd || kind_ == mcap::kFooter;
    if (kind_ == mcap::kSchema || kind_ == mcap::kChannel || kind_ == mcap::kMessage ||
        kind_ == mcap::kChunk) {
      bytes_ = stream_.read(size);
    } else {
      stream_.skip(size);  // an attachment, for example, which may be of any size
    }
    return !at_end_;
  }

  void read_record_of_chunk(ByteCursor& chunk) override {
    kind_ = chunk.number<std::uint8_t>();
    bytes_ = chunk.take(chunk.number<std::uint64_t>());
  }

  bool take_record(BagMessage& message) override {
    const ByteCursor cursor(bytes_);
    if (kind_ == mcap::kSchema) channels_.add_schema(cursor);
    if (kind_ == mcap::kChannel) channels_.add_channel(cursor);
    if (kind_ == mcap::kChunk) open_chunk(cursor);
    return kind_ == mcap::kMessage && take_message(cursor, message);
  }

 private:
  bool take_message(ByteCursor cursor, BagMessage& message) {
    const auto channel = cursor.number<std::uint16_t>();
    if (channels_.topic(channel) == nullptr && !std::exchange(knows_summary_, true))
      channels_.add(channels_of_summary());
    const BagTopic* topic = channels_.topic(channel);
    if (topic == nullptr) return skip_unknown(channel, "channel");
    if (!is_wanted(*topic)) return false;
    cursor.number<std::uint32_t>();  // sequence number of the message
    const auto recorded_ns = cursor.number<std::uint64_t>();
    cursor.number<std::uint64_t>();  // time of publication
    message = {topic, static_cast<TimeUs>(recorded_ns / 1000), cursor.rest()};
    return true;
  }

  void open_chunk(ByteCursor cursor) {
    cursor.take(16);  // times of the first and last message
    const auto size = cursor.number<std::uint64_t>();
    const auto crc = cursor.number<std::uint32_t>();
    const std::string_view compression = text(cursor);
    const std::string_view bytes = cursor.take(cursor.number<std::uint64_t>());
    unpack_chunk(compression, bytes, size);
    if (crc != 0 && crc != crc32_of(chunk_)) throw MalformedBytes("the checksum of a chunk is wrong");
    begin_chunk();
  }

  /// Returns the channels of the summary; none if it is missing or damaged.
  Channels channels_of_summary() const {
    const std::string footer = tail_of_file(stream_.path(), -kFooterBytes);
    const bool is_footer =
        !footer.empty() && footer.front() == mcap::kFooter &&
        footer.compare(footer.size() - mcap::kMagic.size(), mcap::kMagic.size(), mcap::kMagic) == 0;
    if (!is_footer) return {};
    const auto start = ByteCursor(std::string_view(footer).substr(9)).number<std::uint64_t>();
    if (start == 0 || start > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
    const std::string summary = tail_of_file(stream_.path(), static_cast<std::int64_t>(start));
    Channels channels;
    try {
      for (ByteCursor cursor(summary); cursor.left() > static_cast<std::size_t>(kFooterBytes);) {
        const auto kind = cursor.number<std::uint8_t>();
        const ByteCursor record(cursor.take(cursor.number<std::uint64_t>()));
        if (kind == mcap::kSchema) channels.add_schema(record);
        if (kind == mcap::kChannel) channels.add_channel(record);
      }
    } catch (const MalformedBytes&) {
      return {};  // the records before the summary state the channels too
    }
    return channels;
  }

  std::uint8_t kind_ = 0;  // kind of the current record
  std::string_view bytes_;
  Channels channels_;
  bool knows_summary_ = false;  // channels_ contains those of the summary
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<BagFile> open_mcap_bag(const std::filesystem::path& path) {
  return std::make_unique<McapBag>(BagStream(path));
}

std::unique_ptr<BagFile> follow_mcap_bag(std::unique_ptr<ByteSource> recording) {
  return std::make_unique<McapBag>(BagStream(std::move(recording)));
}

}  // namespace psi_slam
