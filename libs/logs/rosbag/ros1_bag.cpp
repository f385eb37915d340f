// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "logs/rosbag/record_bag.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// Fields of a record's header, by name.
using Fields = std::map<std::string_view, std::string_view>;

struct Record {
  Fields fields;
  std::string_view data;
};

enum Operation : std::uint8_t {
  kMessageData = 0x02,
  kBagHeader = 0x03,
  kBagChunk = 0x05,
  kConnection = 0x07
};

Fields fields_of(std::string_view bytes) {
  Fields fields;
  for (ByteCursor cursor(bytes); !cursor.at_end();) {
    const std::string_view field = cursor.take(cursor.number<std::uint32_t>());
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) throw MalformedBytes("a field of its header has no value");
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

std::string_view text_field(const Fields& fields, std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end()) throw MalformedBytes("its header has no field " + std::string(name));
  return field->second;
}

template <class Number>
Number number_field(const Fields& fields, std::string_view name) {
  return ByteCursor(text_field(fields, name)).number<Number>();
}

Record record_of(ByteCursor& cursor) {
  Record record;
  record.fields = fields_of(cursor.take(cursor.number<std::uint32_t>()));
  record.data = cursor.take(cursor.number<std::uint32_t>());
  return record;
}

std::uint8_t operation_of(const Record& record) {
  return number_field<std::uint8_t>(record.fields, "op");
}

BagTopic topic_of(const Record& record) {
  const Fields fields = fields_of(record.data);
  return {std::string(text_field(record.fields, "topic")), std::string(text_field(fields, "type")),
          BagEncoding::kRos1, number_field<std::uint32_t>(record.fields, "conn")};
}

class Ros1Bag final : public RecordBag {
 public:
  explicit Ros1Bag(BagStream stream) : RecordBag(std::move(stream)) {
    if (stream_.read_up_to(kRos1Magic.size()) != kRos1Magic)
      throw UserError(stream_.path().string() +
                      " is not a ROS 1 bag of version 2.0. Convert an older bag with rosbag fix");
    try {
      read_bag_header();
    } catch (const MalformedBytes& error) {
      throw UserError(place() + ": the bag's header is damaged: " + error.what() + ". Fetch the bag again");
    }
  }

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    if (const std::vector<BagTopic> index = connections_of_index(); index.size() >= stated_connections_)
      for (const BagTopic& topic : index) add_topic(topics, topic);
    if (!topics.empty()) return topics;
    Ros1Bag whole{BagStream(stream_.path())};
    const std::optional<UserError> failure = whole.read_to_end();
    for (const auto& [number, topic] : whole.connections_) add_topic(topics, topic);
    if (failure && topics.empty() && !stream_.is_growing()) throw UserError(*failure);
    return topics;
  }

 protected:
  bool read_record_of_file() override {
    record_offset_ = stream_.offset();
    const std::string_view length = stream_.read_up_to(sizeof(std::uint32_t));
    const bool is_cut_off = stream_.is_growing() && length.size() < sizeof(std::uint32_t);
    if (length.empty() || is_cut_off) return false;
    header_ = stream_.read(ByteCursor(length).number<std::uint32_t>());
    record_.fields = fields_of(header_);
    const auto size = ByteCursor(stream_.read(sizeof(std::uint32_t))).number<std::uint32_t>();
    record_.data = stream_.read(size);
    return true;
  }

  void read_record_of_chunk(ByteCursor& chunk) override { record_ = record_of(chunk); }

  bool take_record(BagMessage& message) override {
    const std::uint8_t operation = operation_of(record_);
    if (operation == kConnection) add_connection(topic_of(record_));
    if (operation == kBagChunk) open_chunk(text_field(record_.fields, "compression"));
    return operation == kMessageData && take_message(message);
  }

  void check_end() const override {
    if (index_offset_ == 0)
      throw UserError(stream_.path().string() +
                      " was not closed by its recorder and may lack its end. Repair it with rosbag reindex");
    if (stream_.offset() <= index_offset_)
      throw UserError(stream_.place_of(stream_.offset()) +
                      ": the file is cut off, expected its index at byte " + std::to_string(index_offset_) +
                      ". Fetch the bag again");
  }

 private:
  /// The recorder states the size of a chunk after the last record of the chunk. Until then the size is 0,
  /// and the records of the chunk follow as records of the file.
  void open_chunk(std::string_view compression) {
    if (stream_.is_growing() && record_.data.empty() && compression != "none")
      throw UserError(
          place() + ": a chunk compressed by " + std::string(compression) +
          " is still being recorded, expected no compression in a bag that is followed. Record it "
          "without --bz2 and --lz4");
    unpack_chunk(compression, record_.data, number_field<std::uint32_t>(record_.fields, "size"));
    begin_chunk();
  }

  void read_bag_header() {
    if (!read_record_of_file() || operation_of(record_) != kBagHeader)
      throw MalformedBytes("the first record is not a header");
    index_offset_ = number_field<std::uint64_t>(record_.fields, "index_pos");
    if (record_.fields.count("conn_count") != 0)
      stated_connections_ = number_field<std::uint32_t>(record_.fields, "conn_count");
    const auto encryptor = record_.fields.find("encryptor");
    if (encryptor != record_.fields.end() && !encryptor->second.empty())
      throw UserError(stream_.path().string() + " is encrypted (" + std::string(encryptor->second) +
                      "), expected a plain bag. Decrypt it with rosbag decrypt");
  }

  /// Returns the topic of each connection in the index, up to the end or damage of the index.
  std::vector<BagTopic> connections_of_index() const {
    std::vector<BagTopic> connections;
    const std::string index =
        index_offset_ > 0 ? tail_of_file(stream_.path(), static_cast<std::int64_t>(index_offset_)) : "";
    try {
      for (ByteCursor cursor(index); !cursor.at_end();)
        if (const Record record = record_of(cursor); operation_of(record) == kConnection)
          connections.push_back(topic_of(record));
    } catch (const MalformedBytes&) {
      // The index is truncated or damaged. The chunks hold the connections too.
    }
    return connections;
  }

  void add_connection(const BagTopic& topic) {
    connections_.emplace(static_cast<std::uint32_t>(topic.number), topic);
  }

  bool take_message(BagMessage& message) {
    const auto number = number_field<std::uint32_t>(record_.fields, "conn");
    if (connections_.count(number) == 0 && !std::exchange(knows_index_, true))
      for (const BagTopic& topic : connections_of_index()) add_connection(topic);
    const auto connection = connections_.find(number);
    if (connection == connections_.end()) return skip_unknown(number, "connection");
    if (!is_wanted(connection->second)) return false;
    ByteCursor time(text_field(record_.fields, "time"));
    const auto stamp_s = time.number<std::uint32_t>();
    const auto stamp_ns = time.number<std::uint32_t>();
    message = {&connection->second, TimeUs{stamp_s} * 1'000'000 + stamp_ns / 1000, record_.data};
    return true;
  }

  Record record_;
  std::map<std::uint32_t, BagTopic> connections_;
  std::string header_;
  std::uint64_t index_offset_ = 0;        // stated byte offset of the index; 0 if the bag was not closed
  bool knows_index_ = false;              // connections_ contains those of the index
  std::uint32_t stated_connections_ = 0;  // number of connections that the index should have
};

}  // namespace

std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1Bag>(BagStream(path));
}

std::unique_ptr<BagFile> follow_ros1_bag(std::unique_ptr<ByteSource> recording) {
  return std::make_unique<Ros1Bag>(BagStream(std::move(recording)));
}

}  // namespace psi_slam
