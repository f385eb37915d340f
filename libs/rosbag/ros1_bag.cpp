// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/ros1_bag.h"

#include <algorithm>

#include "psi_slam/user_error.h"
#include "compression/decompression.h"

namespace psi_slam {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";

enum Operation : std::uint8_t { kMessageData = 0x02, kBagHeader = 0x03, kChunk = 0x05, kConnection = 0x07 };

Ros1Fields fields_of(std::string_view bytes) {
  Ros1Fields fields;
  for (ByteCursor cursor(bytes); !cursor.at_end();) {
    const std::string_view field = cursor.take(cursor.number<std::uint32_t>());
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) throw MalformedBytes("a field of its header has no value");
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

std::string_view text_field(const Ros1Fields& fields, std::string_view name) {
  const auto field = fields.find(name);
  if (field == fields.end()) throw MalformedBytes("its header has no field " + std::string(name));
  return field->second;
}

template <class Number>
Number number_field(const Ros1Fields& fields, std::string_view name) {
  return ByteCursor(text_field(fields, name)).number<Number>();
}

Ros1Record record_of(ByteCursor& cursor) {
  Ros1Record record;
  record.fields = fields_of(cursor.take(cursor.number<std::uint32_t>()));
  record.data = cursor.take(cursor.number<std::uint32_t>());
  return record;
}

std::uint8_t operation_of(const Ros1Record& record) {
  return number_field<std::uint8_t>(record.fields, "op");
}

BagTopic topic_of(const Ros1Record& record) {
  const Ros1Fields fields = fields_of(record.data);
  return {std::string(text_field(record.fields, "topic")), std::string(text_field(fields, "type")),
          BagEncoding::kRos1};
}

void add_once(std::vector<BagTopic>& topics, const BagTopic& topic) {
  if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
}

}  // namespace

Ros1Bag::Ros1Bag(const std::filesystem::path& path) : stream_(path) {
  if (stream_.read_up_to(kMagic.size()) != kMagic)
    throw UserError(path.string() + " is no ROS 1 bag of version 2.0; rosbag fix makes one of an older one");
  try {
    read_bag_header();
  } catch (const MalformedBytes& error) {
    throw UserError(place() + ": the bag's header is damaged: " + error.what());
  }
}

void Ros1Bag::read_bag_header() {
  Ros1Record record;
  if (!read_record_of_file(record) || operation_of(record) != kBagHeader)
    throw MalformedBytes("there is none");
  index_offset_ = number_field<std::uint64_t>(record.fields, "index_pos");
  if (record.fields.count("conn_count") != 0)
    connections_told_ = number_field<std::uint32_t>(record.fields, "conn_count");
  const auto encryptor = record.fields.find("encryptor");
  if (encryptor != record.fields.end() && !encryptor->second.empty())
    throw UserError(stream_.path().string() + " is encrypted (" + std::string(encryptor->second) +
                    "), expected a plain bag: rosbag decrypt makes one");
}

bool Ros1Bag::read_record_of_file(Ros1Record& record) {
  record_offset_ = stream_.offset();
  offset_in_chunk_ = 0;
  const std::string_view length = stream_.read_up_to(sizeof(std::uint32_t));
  if (length.empty()) return false;
  header_ = stream_.read(ByteCursor(length).number<std::uint32_t>());
  record.fields = fields_of(header_);
  const auto size = ByteCursor(stream_.read(sizeof(std::uint32_t))).number<std::uint32_t>();
  record.data = stream_.read(size);
  return true;
}

bool Ros1Bag::read_record(Ros1Record& record) {
  if (in_chunk_ && !in_chunk_->at_end()) {
    offset_in_chunk_ = in_chunk_->offset();
    record = record_of(*in_chunk_);
    return true;
  }
  in_chunk_.reset();
  return read_record_of_file(record);
}

bool Ros1Bag::next(BagMessage& message) {
  try {
    for (Ros1Record record; read_record(record);)
      if (take(record, message)) return true;
  } catch (const MalformedBytes& error) {
    throw UserError(place() + ": the bag is damaged: " + error.what());
  }
  check_end();
  return false;
}

bool Ros1Bag::take(const Ros1Record& record, BagMessage& message) {
  switch (operation_of(record)) {
    case kMessageData:
      return take_message(record, message);
    case kConnection:
      add_connection(record);
      return false;
    case kChunk:
      if (in_chunk_) throw MalformedBytes("a chunk stands within a chunk");
      open_chunk(record);
      return false;
    default:  // the index
      return false;
  }
}

void Ros1Bag::open_chunk(const Ros1Record& record) {
  const std::string_view compression = text_field(record.fields, "compression");
  const auto size = number_field<std::uint32_t>(record.fields, "size");
  if (compression == "none") {
    chunk_ = record.data;
  } else if (is_known_compression(compression)) {
    chunk_ = decompress(compression, record.data, size);
  } else {
    throw MalformedBytes("its compression is \"" + std::string(compression) + "\", expected bz2 or lz4");
  }
  in_chunk_.emplace(chunk_);
}

void Ros1Bag::add_connection(const Ros1Record& record) {
  Connection connection{topic_of(record), true};
  connection.is_wanted = is_wanted(connection.topic);
  connections_.emplace(number_field<std::uint32_t>(record.fields, "conn"), std::move(connection));
}

bool Ros1Bag::take_message(const Ros1Record& record, BagMessage& message) const {
  const auto connection = connections_.find(number_field<std::uint32_t>(record.fields, "conn"));
  if (connection == connections_.end()) throw MalformedBytes("a message has no connection");
  if (!connection->second.is_wanted) return false;
  ByteCursor time(text_field(record.fields, "time"));
  const auto stamp_s = time.number<std::uint32_t>();
  const auto stamp_ns = time.number<std::uint32_t>();
  message = {&connection->second.topic, TimeUs{stamp_s} * 1'000'000 + stamp_ns / 1000, record.data};
  return true;
}

void Ros1Bag::check_end() const {
  if (index_offset_ == 0)
    throw UserError(stream_.path().string() +
                    " was not closed by its recorder and may lack its end; rosbag reindex repairs it");
  if (stream_.offset() <= index_offset_)
    throw UserError(stream_.place_of(stream_.offset()) +
                    ": the file is cut off: its index should begin at byte " + std::to_string(index_offset_));
}

std::vector<BagTopic> Ros1Bag::topics() {
  std::vector<BagTopic> topics;
  const std::string index =
      tail_of_file(stream_.path(), static_cast<std::int64_t>(index_offset_)).value_or("");
  const std::string_view told = index_offset_ > 0 ? std::string_view(index) : std::string_view();
  std::uint32_t connections = 0;
  try {
    for (ByteCursor cursor(told); !cursor.at_end();) {
      const Ros1Record record = record_of(cursor);
      if (operation_of(record) != kConnection) continue;
      add_once(topics, topic_of(record));
      ++connections;
    }
    const bool is_whole = connections >= connections_told_;
    if (is_whole && !topics.empty()) return topics;
  } catch (const MalformedBytes&) {
    // An index that is cut off or damaged: the connections stand in the chunks, too.
  }
  topics.clear();
  Ros1Bag whole(stream_.path());
  try {
    for (BagMessage message; whole.next(message);) continue;
  } catch (const UserError&) {
    // What is wrong will be said when reading comes there.
  }
  for (const auto& [number, connection] : whole.connections_) add_once(topics, connection.topic);
  return topics;
}

std::string Ros1Bag::place() const {
  std::string place = stream_.place_of(record_offset_);
  if (in_chunk_) place += ", byte " + std::to_string(offset_in_chunk_) + " of the chunk";
  return place;
}

}  // namespace psi_slam
