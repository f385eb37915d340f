// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/sqlite_connection.h"
#include "logs/rosbag/unpacked_database.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

std::string uri_of(const std::filesystem::path& path) {
  std::string uri = "file:";
  constexpr char kDigits[] = "0123456789ABCDEF";
  for (const char c : path.string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '%' || c == '?' || c == '#') {
      uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
    } else {
      uri += c;
    }
  }
  // A recorder that was killed leaves its last messages in a journal next to the file. Without a journal, the
  // file is opened such that SQLite creates no files next to it.
  const bool has_journal = std::filesystem::exists(path.string() + "-wal");
  return uri + (has_journal ? "?mode=ro" : "?mode=ro&immutable=1");
}

bool is_compressed(const std::filesystem::path& path) {
  constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
  std::string head(kSqliteMagic.size(), '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head != kSqliteMagic;
}

class SqliteBag : public BagFile {
 public:
  explicit SqliteBag(const std::filesystem::path& path) : path_(path), messages_(nullptr, &sqlite3_finalize) {
    if (is_compressed(path)) unpacked_.emplace(path);
    std::error_code ignored;
    try {
      if (unpacked_) {
        database_.emplace("bag", unpacked_->vfs_name(), kMaxRecordBytes);
      } else {
        database_.emplace(uri_of(path), nullptr, std::filesystem::file_size(path, ignored));
      }
      topics_ = database_->topics();
    } catch (const SqliteError& error) {
      fail(error.what());
    }
  }

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    for (const auto& [id, topic] : topics_) add_topic(topics, topic);
    return topics;
  }

  bool next(BagMessage& message) override {
    try {
      if (!messages_) begin_messages();
      if (!database_->step(messages_)) {
        if (unpacked_) unpacked_->unpack_rest();  // damage there may have changed the messages
        return false;
      }
    } catch (const SqliteError& error) {
      fail(error.what());
    }
    sqlite3_stmt* row = messages_.get();
    id_ = sqlite3_column_int64(row, 0);
    const auto topic = topics_.find(sqlite3_column_int64(row, 1));
    if (topic == topics_.end()) fail("it states no topic for message " + std::to_string(id_));
    const auto* data = static_cast<const char*>(sqlite3_column_blob(row, 3));
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 3));
    message = {&topic->second, sqlite3_column_int64(row, 2) / 1000, std::string_view(data, data ? size : 0)};
    return true;
  }

  double progress() const override {
    if (unpacked_) return unpacked_->progress();
    if (last_id_ <= 0) return id_ > 0 ? 1 : 0;
    return std::clamp(static_cast<double>(id_) / static_cast<double>(last_id_), 0.0, 1.0);
  }

  std::string place() const override { return path_.string() + ": message " + std::to_string(id_); }

 private:
  void begin_messages() {
    std::string ids;
    for (const auto& [id, topic] : topics_)
      if (is_wanted(topic)) ids += (ids.empty() ? "" : ",") + std::to_string(id);
    messages_ = database_->prepare("SELECT id, topic_id, timestamp, data FROM messages WHERE topic_id IN (" +
                                   ids + ") ORDER BY id");
    if (unpacked_) return;  // the last message is at the end of the file, which is not unpacked yet
    try {
      const SqliteStatement last = database_->prepare("SELECT max(id) FROM messages");
      if (database_->step(last)) last_id_ = sqlite3_column_int64(last.get(), 0);
    } catch (const SqliteError&) {
      last_id_ = 0;  // the end of the file is missing, so progress is unknown
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    if (unpacked_) unpacked_->rethrow_failure();
    const std::string where =
        id_ > 0 ? path_.string() + ": after message " + std::to_string(id_) : path_.string();
    throw UserError(where + ": the bag is cut off or damaged, or is not a ROS 2 bag (" + reason +
                    "). Fetch the bag again");
  }

  std::filesystem::path path_;
  std::optional<UnpackedDatabase> unpacked_;  // for a compressed file
  std::optional<SqliteConnection> database_;
  SqliteStatement messages_;
  std::map<std::int64_t, BagTopic> topics_;
  std::int64_t id_ = 0;  // number of the last message read
  std::int64_t last_id_ = 0;
};

}  // namespace

std::unique_ptr<BagFile> open_sqlite_bag(const std::filesystem::path& path) {
  return std::make_unique<SqliteBag>(path);
}

}  // namespace psi_slam
