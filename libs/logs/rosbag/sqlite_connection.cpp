// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/sqlite_connection.h"

#include <algorithm>

namespace psi_slam {
namespace {

std::string text_at(const SqliteStatement& row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row.get(), column));
  return text == nullptr ? std::string() : std::string(text);
}

}  // namespace

SqliteConnection::SqliteConnection(const std::string& uri, const char* vfs, std::uintmax_t most_bytes)
    : database_(nullptr, &sqlite3_close) {
  sqlite3* database = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, vfs);
  database_.reset(database);
  if (code != SQLITE_OK) fail(code);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::clamp<std::uintmax_t>(most_bytes, 1 << 20, kMaxRecordBytes)));
  // Without this setting, SQLite rejects a truncated file as a whole.
  sqlite3_exec(database, "PRAGMA writable_schema = ON", nullptr, nullptr, nullptr);
}

SqliteStatement SqliteConnection::prepare(const std::string& query) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), query.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) fail(code);
  return {statement, &sqlite3_finalize};
}

bool SqliteConnection::step(const SqliteStatement& statement) const {
  const int code = sqlite3_step(statement.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) fail(code);
  return code == SQLITE_ROW;
}

std::map<std::int64_t, BagTopic> SqliteConnection::topics() const {
  const SqliteStatement rows = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  std::map<std::int64_t, BagTopic> topics;
  while (step(rows)) {
    const BagEncoding encoding = text_at(rows, 3) == "cdr" ? BagEncoding::kCdr : BagEncoding::kOther;
    const std::int64_t number = sqlite3_column_int64(rows.get(), 0);
    topics[number] = {text_at(rows, 1), ros1_type_name(text_at(rows, 2)), encoding, number};
  }
  return topics;
}

void SqliteConnection::fail(int code) const {
  throw SqliteError(code, database_ ? sqlite3_errmsg(database_.get()) : "out of memory");
}

}  // namespace psi_slam
