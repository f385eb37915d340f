// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/mcap_writer.h"

#include <gmock/gmock.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bag_files.h"
#include "base/byte_cursor.h"
#include "full_disk.h"
#include "logs/frames/log_reader.h"
#include "logs/rosbag/ros2_definitions.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "same_frames.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A message with its topic.
struct WholeMessage {
  BagTopic topic;
  TimeUs recorded_us = 0;
  std::string bytes;
  bool operator==(const WholeMessage& other) const {
    return std::tie(topic, recorded_us, bytes) == std::tie(other.topic, other.recorded_us, other.bytes);
  }
};

WholeMessage whole_message(const Recorded& message) {
  return {{topic_of(message), ros1_type_name(ros2_type_of(message)), BagEncoding::kCdr},
          time_of(message),
          cdr(message)};
}

std::vector<WholeMessage> whole_messages(const Recording& recording) {
  std::vector<WholeMessage> messages;
  for (const Recorded& message : recording) messages.push_back(whole_message(message));
  return messages;
}

void write_messages(McapWriter& writer, const std::vector<WholeMessage>& messages) {
  for (const WholeMessage& message : messages)
    writer.add({&message.topic, message.recorded_us, message.bytes});
}

/// Messages of a file up to its end or to the place where it is cut off.
struct ReadMessages {
  std::vector<WholeMessage> messages;
  std::optional<std::string> failure;
};

ReadMessages read_messages(const fs::path& path) {
  ReadMessages result;
  try {
    const auto bag = open_mcap_bag(path);
    for (BagMessage message; bag->next(message);)
      result.messages.push_back({*message.topic, message.recorded_us, std::string(message.bytes)});
  } catch (const UserError& error) {
    result.failure = error.what();
  }
  return result;
}

/// A record as the specification describes it.
struct SpecRecord {
  std::uint8_t opcode = 0;
  std::size_t offset = 0;  // of the opcode
  std::size_t size = 0;    // with opcode and length
  std::string content;
};

std::vector<SpecRecord> spec_records(const std::string& bytes, std::size_t begin, std::size_t end) {
  std::vector<SpecRecord> records;
  ByteCursor cursor(std::string_view(bytes).substr(0, end));
  cursor.take(begin);
  while (!cursor.at_end()) {
    SpecRecord record;
    record.offset = cursor.offset();
    record.opcode = cursor.number<std::uint8_t>();
    record.content = cursor.take(cursor.number<std::uint64_t>());
    record.size = cursor.offset() - record.offset;
    records.push_back(record);
  }
  return records;
}

std::string spec_text(ByteCursor& cursor) {
  return std::string(cursor.take(cursor.number<std::uint32_t>()));
}

std::uint32_t spec_crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

const std::string kSpecMagic = "\x89MCAP0\r\n";

std::vector<SpecRecord> spec_records(const std::string& file) {
  return spec_records(file, kSpecMagic.size(), file.size() - kSpecMagic.size());
}

class McapWriterTest : public testing::Test {
 protected:
  /// Writes a whole file.
  void write(const std::vector<WholeMessage>& messages) const {
    McapWriter writer(path_);
    write_messages(writer, messages);
    writer.close();
    EXPECT_EQ(writer.failure(), std::nullopt);
    EXPECT_EQ(writer.lost_messages(), 0U);
  }

  std::vector<SpecRecord> chunks() const {
    std::vector<SpecRecord> chunks;
    for (const SpecRecord& record : spec_records(read_file(path_)))
      if (record.opcode == 0x06) chunks.push_back(record);
    return chunks;
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_.path() / "run.mcap";
};

TEST_F(McapWriterTest, is_read_as_it_was_written) {
  Recording recording = recorded_run();
  recording.emplace_back(RecordedImu{"/imu", 1'600'000'001'000'000, "imu", {0, 0, 0.5}});
  const std::vector<WholeMessage> messages = whole_messages(recording);
  write(messages);
  const ReadMessages back = read_messages(path_);
  EXPECT_EQ(back.failure, std::nullopt);
  EXPECT_EQ(back.messages, messages);

  write_mcap(folder_.path() / "expected.mcap", recording);
  EXPECT_EQ(
      expect_same_frames(*open_log_reader(path_, {}), *open_log_reader(folder_.path() / "expected.mcap", {})),
      20U);
}

TEST_F(McapWriterTest, a_second_of_messages_is_a_chunk) {
  Recording recording = recorded_run(60);
  recording.erase(recording.begin());  // the static transform, which is older by years
  write(whole_messages(recording));
  EXPECT_EQ(chunks().size(), 4U) << "3.02 s";
}

TEST_F(McapWriterTest, a_mebibyte_of_messages_is_a_chunk) {
  std::vector<WholeMessage> messages;
  for (int i = 0; i < 30; ++i)
    messages.push_back(
        {{"/points", "sensor_msgs/PointCloud2", BagEncoding::kCdr}, i, std::string(100'000, 'x')});
  write(messages);
  EXPECT_EQ(chunks().size(), 3U);
  EXPECT_EQ(read_messages(path_).messages, messages);
}

TEST_F(McapWriterTest, clocks_that_jump_back_and_times_before_the_epoch_are_written) {
  std::vector<WholeMessage> messages = whole_messages(recorded_run(2));
  messages[1].recorded_us = 5;
  messages[2].recorded_us = -5;
  write(messages);
  messages[2].recorded_us = 0;
  EXPECT_EQ(read_messages(path_).messages, messages);
}

TEST_F(McapWriterTest, without_messages_is_whole) {
  write({});
  const ReadMessages back = read_messages(path_);
  EXPECT_EQ(back.failure, std::nullopt);
  EXPECT_TRUE(back.messages.empty());
}

TEST_F(McapWriterTest, topics_come_from_the_summary) {
  Recording recording = recorded_run();
  write(whole_messages(recording));
  std::string file = read_file(path_);
  for (const SpecRecord& chunk : chunks())
    file.replace(chunk.offset + 9, chunk.size - 9, chunk.size - 9, '\0');
  write_file(path_, file);
  EXPECT_THAT(open_mcap_bag(path_)->topics(),
              testing::ElementsAre(BagTopic{"/tf_static", "tf2_msgs/TFMessage", BagEncoding::kCdr},
                                   BagTopic{"/scan", "sensor_msgs/LaserScan", BagEncoding::kCdr},
                                   BagTopic{"/odom", "nav_msgs/Odometry", BagEncoding::kCdr}));
}

TEST_F(McapWriterTest, a_file_that_is_cut_off_is_read_up_to_the_last_whole_chunk) {
  const std::vector<WholeMessage> messages = whole_messages(recorded_run(60));
  write(messages);
  const std::vector<SpecRecord> all = chunks();
  ASSERT_EQ(all.size(), 5U);
  const std::vector<WholeMessage> whole(messages.begin(),
                                        messages.begin() + 1 + 2 * 70);  // 20 scans, 50 poses
  for (const std::size_t bytes : {all[3].offset, all[3].offset + 5, all[3].offset + all[3].size - 1}) {
    SCOPED_TRACE(bytes);
    fs::resize_file(path_, bytes);
    const ReadMessages back = read_messages(path_);
    EXPECT_EQ(back.messages, whole);
    EXPECT_THAT(back.failure.value_or(""), HasSubstr("the file is cut off"));
    fs::remove(path_);
    write(messages);
  }
}

TEST_F(McapWriterTest, a_killed_run_loses_the_last_second) {
  const std::vector<WholeMessage> messages = whole_messages(recorded_run(60));
  McapWriter writer(path_);
  write_messages(writer, messages);
  const std::size_t whole = 1 + 3 * 70;
  ASSERT_TRUE(soon([&] { return read_messages(path_).messages.size() >= whole; }));
  EXPECT_EQ(read_messages(path_).messages,
            std::vector<WholeMessage>(messages.begin(), messages.begin() + whole));
  writer.close();
  EXPECT_EQ(read_messages(path_).messages, messages);
  writer.close();
  write_messages(writer, messages);
  EXPECT_EQ(read_messages(path_).messages, messages) << "closed";
}

TEST_F(McapWriterTest, the_destructor_finishes_the_file) {
  write(whole_messages(recorded_run()));
  const std::string expected = read_file(path_);
  {
    McapWriter writer(path_, true);
    write_messages(writer, whole_messages(recorded_run()));
  }
  EXPECT_EQ(read_file(path_), expected);
}

TEST_F(McapWriterTest, an_existing_file_is_replaced_only_if_asked) {
  write_file(path_, std::string(10'000, 'x'));
  EXPECT_EQ(sentence_of([&] { const McapWriter writer(path_); }),
            path_.string() +
                " exists already, expected the name of a new file. Choose another name, or delete the file");
  EXPECT_EQ(fs::file_size(path_), 10'000U);
  McapWriter(path_, true).close();
  EXPECT_LT(fs::file_size(path_), 1'000U);
  try {
    const McapWriter writer(folder_.path() / "none" / "run.mcap");
    ADD_FAILURE() << "no SystemFailure";
  } catch (const SystemFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("Choose a folder that exists and is writable"));
  }
}

TEST_F(McapWriterTest, a_full_disk_is_reported_and_not_thrown) {
  McapWriter writer("/dev/full", true);
  write_messages(writer, whole_messages(recorded_run(60)));
  ASSERT_TRUE(soon([&] { return writer.failure().has_value(); }));
  EXPECT_EQ(writer.failure(), "cannot write /dev/full: No space left on device");
  writer.close();
  EXPECT_TRUE(writer.failure().has_value());
}

TEST_F(McapWriterTest, is_whole_again_after_a_full_disk_has_room) {
  const std::vector<WholeMessage> messages = whole_messages(recorded_run(60));
  write(messages);
  const std::string expected = read_file(path_);
  McapWriter writer(path_, true);
  {
    const FullDisk full(300);
    write_messages(writer, messages);
    ASSERT_TRUE(soon([&] { return writer.failure().has_value(); }));
  }
  EXPECT_TRUE(soon([&] { return !writer.failure(); })) << "also without further messages";
  writer.close();
  EXPECT_EQ(read_file(path_), expected);
}

TEST_F(McapWriterTest, after_a_disk_was_full_for_long_the_file_lacks_only_the_lost_messages) {
  std::mt19937_64 random(7);
  std::string noise(std::size_t{1} << 20, '\0');
  for (char& byte : noise) byte = static_cast<char>(random() & 0xFFU);
  const BagTopic first{"/points", "sensor_msgs/PointCloud2", BagEncoding::kCdr};
  const BagTopic second{"/more", "sensor_msgs/PointCloud2", BagEncoding::kCdr};
  McapWriter writer(path_);
  {
    const FullDisk full(300);
    for (TimeUs i = 0; i < 80; ++i) writer.add({i < 70 ? &first : &second, i, noise});
    ASSERT_TRUE(soon([&] { return writer.failure().has_value(); }));
  }
  EXPECT_GE(writer.lost_messages(), 80 - AppendedFile::kMostWaitingBytes / noise.size());
  ASSERT_TRUE(soon([&] { return !writer.failure(); }));
  writer.add({&second, 100, noise});
  writer.close();
  EXPECT_EQ(writer.failure(), std::nullopt);
  fs::resize_file(path_, fs::file_size(path_) - 1);  // no summary: the chunks state all channels
  const ReadMessages back = read_messages(path_);
  EXPECT_EQ(back.failure, std::nullopt);
  EXPECT_EQ(back.messages.size() + writer.lost_messages(), 81U);
  EXPECT_EQ(back.messages.back().topic, second);
}

/// Reads a file as the specification says, without psi-slam's reader, and keeps what its sections state.
class SpecFile {
 public:
  explicit SpecFile(std::string bytes) : bytes_(std::move(bytes)), records_(spec_records(bytes_)) {}

  void check() {
    EXPECT_EQ(bytes_.substr(0, 8), kSpecMagic);
    EXPECT_EQ(bytes_.substr(bytes_.size() - 8), kSpecMagic);
    ASSERT_GE(records_.size(), 3U);
    check_header();
    std::size_t i = 1;
    while (records_[i].opcode == 0x06) i = check_chunk(i);
    ASSERT_EQ(records_[i].opcode, 0x0F);
    EXPECT_EQ(records_[i].content.size(), 4U);
    check_summary(i + 1);
    check_footer(records_[i + 1].offset);
  }

  std::map<std::uint16_t, std::string> schemas;   // name
  std::map<std::uint16_t, std::string> channels;  // topic
  std::map<std::uint16_t, std::uint64_t> counts;  // messages of each channel
  std::vector<std::string> messages;

 private:
  void check_header() const {
    ByteCursor cursor(records_[0].content);
    EXPECT_EQ(records_[0].opcode, 0x01);
    EXPECT_EQ(spec_text(cursor), "ros2");
    EXPECT_EQ(spec_text(cursor), "psi-slam " PSI_SLAM_VERSION);
    EXPECT_TRUE(cursor.at_end());
  }

  void take_schema(const SpecRecord& record) {
    ByteCursor cursor(record.content);
    const auto id = cursor.number<std::uint16_t>();
    const std::string name = spec_text(cursor);
    EXPECT_GT(id, 0U);
    EXPECT_EQ(spec_text(cursor), "ros2msg");
    EXPECT_EQ(spec_text(cursor), ros2_definition(ros1_type_name(name)));
    EXPECT_TRUE(cursor.at_end());
    EXPECT_EQ(schemas.emplace(id, name).first->second, name);
  }

  void take_channel(const SpecRecord& record) {
    ByteCursor cursor(record.content);
    const auto id = cursor.number<std::uint16_t>();
    EXPECT_EQ(schemas.count(cursor.number<std::uint16_t>()), 1U);
    const std::string topic = spec_text(cursor);
    EXPECT_EQ(spec_text(cursor), "cdr");
    const std::string metadata = spec_text(cursor);
    ByteCursor entries(metadata);
    EXPECT_EQ(spec_text(entries), "offered_qos_profiles");
    EXPECT_EQ(spec_text(entries), "");
    EXPECT_TRUE(entries.at_end());
    EXPECT_TRUE(cursor.at_end());
    EXPECT_EQ(channels.emplace(id, topic).first->second, topic);
  }

  /// Takes a message of a chunk whose times are `first` to `last`. Adds its place to `places`.
  void take_message(const SpecRecord& record, std::uint64_t first, std::uint64_t last,
                    std::map<std::uint16_t, std::set<std::pair<std::uint64_t, std::uint64_t>>>& places) {
    ByteCursor cursor(record.content);
    const auto channel = cursor.number<std::uint16_t>();
    EXPECT_EQ(channels.count(channel), 1U);
    EXPECT_EQ(cursor.number<std::uint32_t>(), counts[channel]++) << "sequence number";
    const auto log_time = cursor.number<std::uint64_t>();
    EXPECT_EQ(cursor.number<std::uint64_t>(), log_time) << "time of publication";
    EXPECT_GE(log_time, first);
    EXPECT_LE(log_time, last);
    messages.emplace_back(cursor.rest());
    places[channel].emplace(log_time, record.offset);
    begin_ = std::min(begin_, log_time);
    end_ = std::max(end_, log_time);
  }

  /// Checks the chunk that is record `i` and the message indexes after it. Returns the next record.
  std::size_t check_chunk(std::size_t i) {
    ByteCursor cursor(records_[i].content);
    const auto first = cursor.number<std::uint64_t>();
    const auto last = cursor.number<std::uint64_t>();
    const auto size = cursor.number<std::uint64_t>();
    const auto crc = cursor.number<std::uint32_t>();
    EXPECT_EQ(spec_text(cursor), "zstd");
    const std::string packed(cursor.take(cursor.number<std::uint64_t>()));
    EXPECT_TRUE(cursor.at_end());
    std::string chunk(size, '\0');
    EXPECT_EQ(ZSTD_decompress(chunk.data(), chunk.size(), packed.data(), packed.size()), size);
    EXPECT_EQ(crc, spec_crc(chunk));
    EXPECT_NE(crc, 0U);

    std::map<std::uint16_t, std::set<std::pair<std::uint64_t, std::uint64_t>>> places;
    for (const SpecRecord& record : spec_records(chunk, 0, chunk.size())) {
      EXPECT_TRUE(record.opcode >= 0x03 && record.opcode <= 0x05);
      if (record.opcode == 0x03) take_schema(record);
      if (record.opcode == 0x04) take_channel(record);
      if (record.opcode == 0x05) take_message(record, first, last, places);
    }
    const std::size_t chunk_record = i;
    std::string offsets;
    for (++i; records_[i].opcode == 0x07; ++i) {
      ByteCursor index(records_[i].content);
      const auto channel = index.number<std::uint16_t>();
      ByteCursor entries(index.take(index.number<std::uint32_t>()));
      EXPECT_TRUE(index.at_end());
      while (!entries.at_end()) {
        const auto time = entries.number<std::uint64_t>();
        EXPECT_EQ(places[channel].erase({time, entries.number<std::uint64_t>()}), 1U);
      }
      EXPECT_TRUE(places[channel].empty()) << "messages without index";
      places.erase(channel);
      offsets += records_[i].content.substr(0, 2) + number_bytes(records_[i].offset);
    }
    EXPECT_TRUE(places.empty()) << "channels without index";
    const std::size_t end = records_[i].offset;
    chunk_indexes_.push_back(
        records_[chunk_record].content.substr(0, 16) + number_bytes(records_[chunk_record].offset) +
        number_bytes(records_[chunk_record].size) + number_bytes(offsets.size()).substr(0, 4) + offsets +
        number_bytes(end - records_[chunk_record].offset - records_[chunk_record].size) +
        number_bytes(4).substr(0, 4) + "zstd" + number_bytes(packed.size()) + number_bytes(size));
    return i;
  }

  static std::string number_bytes(std::uint64_t number) {
    std::string bytes;
    for (int i = 0; i < 8; ++i, number /= 256) bytes += static_cast<char>(number % 256);
    return bytes;
  }

  void check_summary(std::size_t i) {
    const auto all_schemas = schemas;
    const auto all_channels = channels;
    schemas.clear();
    channels.clear();
    std::vector<std::string> chunk_indexes;
    std::string groups;  // opcodes without repetitions
    std::size_t statistics = 0;
    for (; i + 1 < records_.size(); ++i) {
      const SpecRecord& record = records_[i];
      if (groups.empty() || groups.back() != static_cast<char>(record.opcode))
        groups += static_cast<char>(record.opcode);
      if (record.opcode == 0x03) take_schema(record);
      if (record.opcode == 0x04) take_channel(record);
      if (record.opcode == 0x08) chunk_indexes.push_back(record.content);
      if (record.opcode == 0x0B) check_statistics(record), ++statistics;
    }
    EXPECT_EQ(groups, "\x03\x04\x08\x0B");
    EXPECT_EQ(schemas, all_schemas);
    EXPECT_EQ(channels, all_channels);
    EXPECT_EQ(chunk_indexes, chunk_indexes_);
    EXPECT_EQ(statistics, 1U);
  }

  void check_statistics(const SpecRecord& record) {
    ByteCursor cursor(record.content);
    EXPECT_EQ(cursor.number<std::uint64_t>(), messages.size());
    EXPECT_EQ(cursor.number<std::uint16_t>(), schemas.size());
    EXPECT_EQ(cursor.number<std::uint32_t>(), channels.size());
    EXPECT_EQ(cursor.number<std::uint32_t>(), 0U) << "attachments";
    EXPECT_EQ(cursor.number<std::uint32_t>(), 0U) << "metadata";
    EXPECT_EQ(cursor.number<std::uint32_t>(), chunk_indexes_.size());
    EXPECT_EQ(cursor.number<std::uint64_t>(), begin_);
    EXPECT_EQ(cursor.number<std::uint64_t>(), end_);
    ByteCursor entries(cursor.take(cursor.number<std::uint32_t>()));
    EXPECT_TRUE(cursor.at_end());
    std::map<std::uint16_t, std::uint64_t> stated;
    while (!entries.at_end()) {
      const auto channel = entries.number<std::uint16_t>();
      stated[channel] = entries.number<std::uint64_t>();
    }
    EXPECT_EQ(stated, counts);
  }

  void check_footer(std::size_t summary_start) const {
    const SpecRecord& footer = records_.back();
    EXPECT_EQ(footer.opcode, 0x02);
    ByteCursor cursor(footer.content);
    EXPECT_EQ(cursor.number<std::uint64_t>(), summary_start);
    EXPECT_EQ(cursor.number<std::uint64_t>(), 0U) << "no summary offsets";
    const std::size_t crc_offset = footer.offset + 9 + 16;
    EXPECT_EQ(cursor.number<std::uint32_t>(),
              spec_crc(bytes_.substr(summary_start, crc_offset - summary_start)));
    EXPECT_TRUE(cursor.at_end());
  }

  std::string bytes_;
  std::vector<SpecRecord> records_;
  std::vector<std::string> chunk_indexes_;  // contents expected in the summary
  std::uint64_t begin_ = ~std::uint64_t{0};
  std::uint64_t end_ = 0;
};

TEST_F(McapWriterTest, has_the_bytes_of_the_specification) {
  Recording recording = recorded_run(60);
  RecordedScan other;
  other.topic = "/rear/scan";
  other.time_us = time_of(recording.back());
  recording.emplace_back(other);
  std::vector<WholeMessage> messages = whole_messages(recording);
  messages.push_back({{"/other", "my_msgs/Other", BagEncoding::kCdr}, other.time_us, "bytes"});
  write(messages);
  SpecFile file(read_file(path_));
  ASSERT_NO_FATAL_FAILURE(file.check());
  ASSERT_EQ(file.messages.size(), messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) EXPECT_EQ(file.messages[i], messages[i].bytes);
  EXPECT_THAT(
      file.schemas,
      testing::ElementsAre(std::pair(1, "tf2_msgs/msg/TFMessage"), std::pair(2, "sensor_msgs/msg/LaserScan"),
                           std::pair(3, "nav_msgs/msg/Odometry"), std::pair(4, "my_msgs/msg/Other")));
  EXPECT_THAT(file.channels,
              testing::ElementsAre(std::pair(1, "/tf_static"), std::pair(2, "/scan"), std::pair(3, "/odom"),
                                   std::pair(4, "/rear/scan"), std::pair(5, "/other")));
}

}  // namespace
}  // namespace psi_slam
