// SPDX-License-Identifier: BSD-3-Clause
#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/growing_database.h"
#include "logs/rosbag/sqlite_connection.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;
using Topics = std::map<std::int64_t, BagTopic>;  // by their numbers

// Limits of one reading, so that the recorder rarely writes meanwhile. They are halved if it did.
constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr std::size_t kMostRows = 1000;
// Readings in a row, until the reader waits for the recorder.
constexpr int kAttempts = 25;
constexpr std::chrono::milliseconds kBetweenAttempts{2};

struct Row {
  std::int64_t id = 0;
  std::int64_t topic = 0;
  std::int64_t recorded_ns = 0;
  std::string data;
};

double elapsed_s(Clock::duration time) {
  return std::chrono::duration<double>(time).count();
}

/// Returns whether rosbag2 has created its tables.
bool has_tables(const SqliteConnection& connection) {
  const SqliteStatement tables =
      connection.prepare("SELECT count(*) FROM sqlite_master WHERE name IN ('topics', 'messages')");
  return connection.step(tables) && sqlite3_column_int(tables.get(), 0) == 2;
}

class GrowingSqliteBag : public BagFile {
 public:
  GrowingSqliteBag(std::filesystem::path path, BagRecorder recorder)
      : path_(std::move(path)), recorder_(std::move(recorder)), database_(path_) {}

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    for (const auto& [id, topic] : topics_) add_topic(topics, topic);
    return topics;
  }

  bool next(BagMessage& message) override {
    Clock::time_point last_row = Clock::now();  // of any topic
    Clock::time_point last_readable = last_row;
    while (rows_.empty()) {
      if (recorder_.should_stop()) return false;
      const bool is_closed = recorder_.is_closed();
      const Reading reading = read_rows();
      const Clock::time_point now = Clock::now();
      if (reading == Reading::kRows) last_row = now;
      if (reading == Reading::kRows || reading == Reading::kNoRows)
        last_readable = now;
      else if (elapsed_s(now - last_readable) >= recorder_.notice_after_s)
        notify_once(reading);
      if (reading == Reading::kRows) continue;
      const bool is_over = is_closed && reading != Reading::kBusy;
      if (is_over || !recorder_.wait(elapsed_s(now - last_row))) return false;
    }
    row_ = std::move(rows_.front());
    rows_.pop_front();
    message = {&topics_.at(row_.topic), row_.recorded_ns / 1000, row_.data};
    return true;
  }

  double progress() const override { return 0; }
  std::string place() const override { return path_.string() + ": message " + std::to_string(row_.id); }

 private:
  enum class Reading {
    kRows,      ///< there were more rows, perhaps only unwanted ones
    kNoRows,    ///< there were none
    kNoTables,  ///< the recorder has not created its tables yet
    kBusy       ///< the recorder was always writing
  };

  /// Says once why nothing can be read.
  void notify_once(Reading reading) {
    if (has_notified_) return;
    has_notified_ = true;
    recorder_.notify(
        path_.string() +
        (reading == Reading::kBusy
             ? " cannot be read, because its recorder locks it all the time or was killed while it wrote. "
               "Record without locking_mode=EXCLUSIVE, or read the file of a killed recorder once with "
               "sqlite3"
             : " has no tables of a ROS 2 bag yet. Check that a recorder of ROS 2 writes it"));
  }

  /// Reads the next rows. Throws UserError if the database is damaged.
  Reading read_rows() {
    std::optional<SqliteError> failure;
    std::size_t most_rows = kMostRows;
    std::size_t most_bytes = kMostBytes;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      if (attempt > 0) std::this_thread::sleep_for(kBetweenAttempts);
      failure.reset();
      if (!database_.begin()) continue;
      if (database_.is_empty()) return Reading::kNoTables;
      std::optional<std::deque<Row>> rows;
      Topics topics;
      try {
        rows = query(topics, most_rows, most_bytes);
      } catch (const SqliteError& error) {
        failure = error;
      }
      if (!database_.is_unchanged()) {
        failure.reset();
        most_rows = std::max<std::size_t>(most_rows / 2, 1);
        most_bytes /= 2;
        continue;
      }
      if (failure) continue;
      if (!rows) return Reading::kNoTables;
      topics_ = std::move(topics);
      if (rows->empty()) return Reading::kNoRows;
      last_id_ = rows->back().id;
      for (Row& row : *rows)
        if (is_wanted(topics_.at(row.topic))) rows_.push_back(std::move(row));
      return Reading::kRows;
    }
    if (failure) fail(*failure);
    return Reading::kBusy;
  }

  /// Reads at least one row after the last one, if there is any, and the topics. Ends after `most_rows` or
  /// the row that reaches `most_bytes`. The data of unwanted rows are empty. Returns nothing if there are no
  /// tables.
  std::optional<std::deque<Row>> query(Topics& topics, std::size_t most_rows, std::size_t most_bytes) {
    const SqliteConnection connection("bag", database_.vfs_name(), kMaxRecordBytes);
    if (topics_.empty() && !has_tables(connection)) return std::nullopt;
    topics = connection.topics();
    std::string ids;
    for (const auto& [id, topic] : topics)
      if (is_wanted(topic)) ids += (ids.empty() ? "" : ",") + std::to_string(id);
    const SqliteStatement messages = connection.prepare(
        "SELECT id, topic_id, timestamp, CASE WHEN topic_id IN (" + ids +
        ") THEN data END FROM messages WHERE id > " + std::to_string(last_id_) + " ORDER BY id");
    std::deque<Row> rows;
    std::size_t bytes = 0;
    while ((rows.empty() || bytes < most_bytes) && rows.size() < most_rows && connection.step(messages)) {
      sqlite3_stmt* const row = messages.get();
      const std::int64_t topic = sqlite3_column_int64(row, 1);
      if (topics.count(topic) == 0) throw SqliteError(SQLITE_CORRUPT, "it states no topic for a message");
      const auto* const data = static_cast<const char*>(sqlite3_column_blob(row, 3));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, 3));
      rows.push_back({sqlite3_column_int64(row, 0), topic, sqlite3_column_int64(row, 2),
                      data == nullptr ? std::string() : std::string(data, size)});
      bytes += size;
    }
    return rows;
  }

  [[noreturn]] void fail(const SqliteError& error) const {
    database_.rethrow_failure();
    throw UserError(path_.string() + ": after message " + std::to_string(last_id_) +
                    ": the bag is damaged, or is not a ROS 2 bag (" + error.what() +
                    "). Record the bag again");
  }

  std::filesystem::path path_;
  BagRecorder recorder_;
  GrowingDatabase database_;
  Topics topics_;
  std::deque<Row> rows_;      // that next() returns
  Row row_;                   // that next() returned last
  std::int64_t last_id_ = 0;  // number of the last row that was read
  bool has_notified_ = false;
};

}  // namespace

std::unique_ptr<BagFile> follow_sqlite_bag(const std::filesystem::path& path, BagRecorder recorder) {
  return std::make_unique<GrowingSqliteBag>(path, std::move(recorder));
}

}  // namespace psi_slam
