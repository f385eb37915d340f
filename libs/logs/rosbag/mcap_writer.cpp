// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/mcap_writer.h"

#include <cstddef>
#include <exception>
#include <string_view>
#include <utility>

#include "base/compression/compression.h"
#include "logs/rosbag/mcap_records.h"
#include "logs/rosbag/ros2_definitions.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

using mcap::packed;
using mcap::packed_text;

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::uint64_t kChunkNs = 1'000'000'000;
constexpr std::string_view kCompression = "zstd";
constexpr std::size_t kIndexEntryBytes = 16;  // a time and an offset

std::string header() {
  return mcap::record(mcap::kHeader, packed_text("ros2") + packed_text("psi-slam " PSI_SLAM_VERSION));
}

/// Returns the end of a file whose summary begins at `summary_start`: the summary, footer and last bytes.
std::string end_of_file(std::uint64_t summary_start, const std::string& summary) {
  constexpr std::uint64_t kContentBytes = 8 + 8 + 4;
  constexpr std::uint64_t kNoSummaryOffsets = 0;
  const std::string checked = summary + packed(std::uint8_t{mcap::kFooter}) + packed(kContentBytes) +
                              packed(summary_start) + packed(kNoSummaryOffsets);
  return (checked + packed(crc32_of(checked))).append(mcap::kMagic);
}

}  // namespace

McapWriter::McapWriter(std::filesystem::path path, bool overwrite) : file_(std::move(path), overwrite) {
  append(std::string(mcap::kMagic) + header());
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (const std::exception&) {
    // The file lacks its last chunk, as that of a run that was killed.
  }
}

void McapWriter::add(const BagMessage& message) {
  if (is_closed_) return;
  const TimeNs time = static_cast<TimeNs>(std::max<TimeUs>(message.recorded_us, 0)) * 1000;
  TimeSpan times = chunk_.times;
  times.include(time);
  if (times.last - times.first >= kChunkNs) end_chunk();
  chunk_.times.include(time);
  const ChannelId channel = stated_channel(*message.topic);
  chunk_.index[channel] += packed(time) + packed(std::uint64_t{chunk_.records.size()});
  const std::uint32_t sequence = channels_[channel - 1].sequence++;
  chunk_.records +=
      mcap::record(mcap::kMessage,
                   (packed(channel) + packed(sequence) + packed(time) + packed(time)).append(message.bytes));
  if (chunk_.records.size() >= kChunkBytes) end_chunk();
}

void McapWriter::close() {
  if (std::exchange(is_closed_, true)) return;
  end_chunk();
  constexpr std::uint32_t kNoChecksum = 0;
  append(mcap::record(mcap::kDataEnd, packed(kNoChecksum)));
  append(end_of_file(file_bytes_, summary()));
  file_.close();
}

/// Appends bytes to the file. Returns whether the file takes them.
bool McapWriter::append(const std::string& bytes) {
  if (!file_.append(bytes)) return false;
  file_bytes_ += bytes.size();
  return true;
}

/// Returns the number of a topic's channel. States the channel and its schema in the chunk if none did so
/// far.
McapWriter::ChannelId McapWriter::stated_channel(const BagTopic& topic) {
  const ChannelId id = channel_of(topic);
  Channel& channel = channels_[id - 1];
  if (!std::exchange(channel.is_stated, true))
    chunk_.records += schema_record(channel.schema) + channel_record(id);
  return id;
}

McapWriter::ChannelId McapWriter::channel_of(const BagTopic& topic) {
  const std::uint16_t schema = schema_of(ros1_type_name(topic.type));
  auto found = std::find_if(channels_.begin(), channels_.end(), [&](const Channel& channel) {
    return channel.topic == topic.name && channel.schema == schema;
  });
  if (found == channels_.end()) found = channels_.insert(found, Channel{topic.name, schema});
  return static_cast<ChannelId>(found - channels_.begin() + 1);
}

std::uint16_t McapWriter::schema_of(const std::string& type) {
  auto found = std::find(schemas_.begin(), schemas_.end(), type);
  if (found == schemas_.end()) found = schemas_.insert(found, type);
  return static_cast<std::uint16_t>(found - schemas_.begin() + 1);
}

std::string McapWriter::schema_record(std::uint16_t id) const {
  const std::string& type = schemas_[id - 1];
  return mcap::record(mcap::kSchema, packed(id) + packed_text(ros2_type_name(type)) + packed_text("ros2msg") +
                                         packed_text(ros2_definition(type)));
}

std::string McapWriter::channel_record(ChannelId id) const {
  const Channel& channel = channels_[id - 1];
  const std::string no_profiles = packed_text("offered_qos_profiles") + packed_text("");
  return mcap::record(mcap::kChannel, packed(id) + packed(channel.schema) + packed_text(channel.topic) +
                                          packed_text("cdr") + packed_text(no_profiles));
}

void McapWriter::end_chunk() {
  const Chunk chunk = std::exchange(chunk_, {});
  if (chunk.index.empty()) return;
  const std::string compressed = zstd_compressed(chunk.records);
  const std::string times = packed(chunk.times.first) + packed(chunk.times.last);
  const std::uint64_t size = chunk.records.size();
  const std::uint64_t compressed_size = compressed.size();
  std::string bytes =
      mcap::record(mcap::kChunk, times + packed(size) + packed(crc32_of(chunk.records)) +
                                     packed_text(kCompression) + packed(compressed_size) + compressed);
  const std::uint64_t chunk_bytes = bytes.size();
  std::string index_offsets;
  for (const auto& [channel, entries] : chunk.index) {
    index_offsets += packed(channel) + packed(file_bytes_ + bytes.size());
    bytes += mcap::record(mcap::kMessageIndex, packed(channel) + packed_text(entries));
  }
  const std::string chunk_index =
      mcap::record(mcap::kChunkIndex, times + packed(file_bytes_) + packed(chunk_bytes) +
                                          packed_text(index_offsets) + packed(bytes.size() - chunk_bytes) +
                                          packed_text(kCompression) + packed(compressed_size) + packed(size));
  if (!append(bytes)) return lose_messages(chunk);
  chunk_indexes_ += chunk_index;
  count_messages(chunk);
}

void McapWriter::count_messages(const Chunk& chunk) {
  ++chunk_count_;
  times_.include(chunk.times.first);
  times_.include(chunk.times.last);
  for (const auto& [channel, entries] : chunk.index)
    channels_[channel - 1].message_count += entries.size() / kIndexEntryBytes;
}

void McapWriter::lose_messages(const Chunk& chunk) {
  for (const auto& [channel, entries] : chunk.index) {
    lost_messages_ += entries.size() / kIndexEntryBytes;
    channels_[channel - 1].is_stated = false;
  }
}

std::string McapWriter::statistics() const {
  constexpr std::uint32_t kNone = 0;
  std::uint64_t messages = 0;
  std::string counts;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    messages += channels_[i].message_count;
    counts += packed(static_cast<ChannelId>(i + 1)) + packed(channels_[i].message_count);
  }
  const TimeSpan times = chunk_count_ > 0 ? times_ : TimeSpan{0, 0};
  return mcap::record(mcap::kStatistics, packed(messages) +
                                             packed(static_cast<std::uint16_t>(schemas_.size())) +
                                             packed(static_cast<std::uint32_t>(channels_.size())) +
                                             packed(kNone) + packed(kNone) + packed(chunk_count_) +
                                             packed(times.first) + packed(times.last) + packed_text(counts));
}

std::string McapWriter::summary() const {
  std::string summary;
  for (std::size_t i = 0; i < schemas_.size(); ++i)
    summary += schema_record(static_cast<std::uint16_t>(i + 1));
  for (std::size_t i = 0; i < channels_.size(); ++i) summary += channel_record(static_cast<ChannelId>(i + 1));
  return summary + chunk_indexes_ + statistics();
}

}  // namespace psi_slam
