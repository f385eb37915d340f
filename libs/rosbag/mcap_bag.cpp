// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/mcap_bag.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "psi_slam/user_error.h"
#include "compression/decompression.h"

namespace psi_slam {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::int64_t kFooterBytes = 1 + 8 + 20 + 8;  // with the magic behind it

enum Kind : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0F
};

std::string_view text(ByteCursor& cursor) {
  return cursor.take(cursor.number<std::uint32_t>());
}

std::string_view long_piece(ByteCursor& cursor, std::uint64_t size) {
  return cursor.take(static_cast<std::size_t>(size));
}

BagEncoding encoding_named(std::string_view name) {
  if (name == "cdr") return BagEncoding::kCdr;
  return name == "ros1" ? BagEncoding::kRos1 : BagEncoding::kOther;
}

std::uint32_t crc_of(std::string_view bytes) {
  uLong crc = crc32(0, nullptr, 0);
  while (!bytes.empty()) {
    const std::string_view piece = bytes.substr(0, std::size_t{1} << 30);
    crc = crc32(crc, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
    bytes.remove_prefix(piece.size());
  }
  return static_cast<std::uint32_t>(crc);
}

}  // namespace

void McapChannels::add_schema(ByteCursor record) {
  const auto id = record.number<std::uint16_t>();
  schemas_[id] = ros1_type_name(text(record));
}

void McapChannels::add_channel(ByteCursor record) {
  const auto id = record.number<std::uint16_t>();
  const auto schema = schemas_.find(record.number<std::uint16_t>());
  BagTopic topic;
  topic.name = text(record);
  topic.encoding = encoding_named(text(record));
  if (schema != schemas_.end()) topic.type = schema->second;
  channels_.emplace(id, std::move(topic));
}

const BagTopic* McapChannels::topic(std::uint16_t channel) const {
  const auto found = channels_.find(channel);
  return found == channels_.end() ? nullptr : &found->second;
}

std::vector<BagTopic> McapChannels::topics() const {
  std::vector<BagTopic> topics;
  for (const auto& [id, topic] : channels_)
    if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
  return topics;
}

McapBag::McapBag(const std::filesystem::path& path) : stream_(path) {
  if (stream_.read_up_to(kMagic.size()) != kMagic)
    throw UserError(path.string() + " is no MCAP file of version 0");
}

bool McapBag::read_record(Record& record) {
  if (in_chunk_ && !in_chunk_->at_end()) {
    offset_in_chunk_ = in_chunk_->offset();
    record.kind = in_chunk_->number<std::uint8_t>();
    record.bytes = long_piece(*in_chunk_, in_chunk_->number<std::uint64_t>());
    return true;
  }
  in_chunk_.reset();
  if (at_end_) return false;
  record_offset_ = stream_.offset();
  ByteCursor head(stream_.read(9));
  record.kind = head.number<std::uint8_t>();
  record.bytes = stream_.read(head.number<std::uint64_t>());
  at_end_ = record.kind == kDataEnd || record.kind == kFooter;
  return !at_end_;
}

bool McapBag::next(BagMessage& message) {
  try {
    for (Record record; read_record(record);)
      if (take(record, message)) return true;
  } catch (const MalformedBytes& error) {
    throw UserError(place() + ": the bag is damaged: " + error.what());
  }
  return false;
}

bool McapBag::take(const Record& record, BagMessage& message) {
  const ByteCursor cursor(record.bytes);
  switch (record.kind) {
    case kSchema:
      channels_.add_schema(cursor);
      return false;
    case kChannel:
      channels_.add_channel(cursor);
      return false;
    case kMessage:
      return take_message(cursor, message);
    case kChunk:
      if (in_chunk_) throw MalformedBytes("a chunk stands within a chunk");
      open_chunk(cursor);
      return false;
    default:  // indices, attachments, metadata
      return false;
  }
}

bool McapBag::take_message(ByteCursor cursor, BagMessage& message) const {
  const BagTopic* topic = channels_.topic(cursor.number<std::uint16_t>());
  if (topic == nullptr) throw MalformedBytes("a message has no channel");
  if (!is_wanted(*topic)) return false;
  cursor.number<std::uint32_t>();  // its number in the channel
  const auto recorded_ns = cursor.number<std::uint64_t>();
  cursor.number<std::uint64_t>();  // when it was published
  message = {topic, static_cast<TimeUs>(recorded_ns / 1000), cursor.rest()};
  return true;
}

void McapBag::open_chunk(ByteCursor cursor) {
  cursor.take(16);  // the times of its first and last message
  const auto size = cursor.number<std::uint64_t>();
  const auto crc = cursor.number<std::uint32_t>();
  const std::string_view compression = text(cursor);
  const std::string_view bytes = long_piece(cursor, cursor.number<std::uint64_t>());
  if (compression.empty()) {
    chunk_ = bytes;
  } else if (is_known_compression(compression)) {
    chunk_ = decompress(compression, bytes, size);
  } else {
    throw MalformedBytes("its compression is \"" + std::string(compression) + "\", expected lz4 or zstd");
  }
  if (crc != 0 && crc != crc_of(chunk_)) throw MalformedBytes("the checksum of a chunk is another");
  in_chunk_.emplace(chunk_);
}

std::vector<BagTopic> McapBag::topics_of_summary() const {
  const std::string footer = tail_of_file(stream_.path(), -kFooterBytes).value_or("");
  if (footer.empty() || footer.front() != kFooter) return {};
  const auto start = ByteCursor(std::string_view(footer).substr(9)).number<std::uint64_t>();
  if (start == 0 || start > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
  const std::string summary = tail_of_file(stream_.path(), static_cast<std::int64_t>(start)).value_or("");
  McapChannels channels;
  for (ByteCursor cursor(summary); cursor.left() > static_cast<std::size_t>(kFooterBytes);) {
    const auto kind = cursor.number<std::uint8_t>();
    const ByteCursor record(long_piece(cursor, cursor.number<std::uint64_t>()));
    if (kind == kSchema) channels.add_schema(record);
    if (kind == kChannel) channels.add_channel(record);
  }
  return channels.topics();
}

std::vector<BagTopic> McapBag::topics() {
  try {
    if (auto topics = topics_of_summary(); !topics.empty()) return topics;
  } catch (const MalformedBytes&) {
    // Then the records in front of it tell.
  }
  McapBag whole(stream_.path());
  try {
    for (BagMessage message; whole.next(message);) continue;
  } catch (const UserError&) {
    // What is wrong will be said when reading comes there.
  }
  return whole.channels_.topics();
}

std::string McapBag::place() const {
  std::string place = stream_.place_of(record_offset_);
  if (in_chunk_) place += ", byte " + std::to_string(offset_in_chunk_) + " of the chunk";
  return place;
}

}  // namespace psi_slam
