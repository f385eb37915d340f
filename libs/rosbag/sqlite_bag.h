// SPDX-License-Identifier: BSD-3-Clause
// ROS 2 bags in SQLite files (.db3): a table of topics and one of messages, read in the order in which they
// were recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rosbag/bag_file.h"

struct sqlite3;
struct sqlite3_stmt;

namespace psi_slam {

class SqliteBag : public BagFile {
 public:
  explicit SqliteBag(const std::filesystem::path& path);
  ~SqliteBag() override;

  std::vector<BagTopic> topics() override;
  bool next(BagMessage& message) override;
  double progress() const override;
  std::string place() const override;

 private:
  using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
  using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

  Statement prepare(const std::string& query) const;
  bool step(const Statement& statement) const;
  void read_topics();
  void begin_messages();
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  Database database_;
  Statement messages_;
  std::map<std::int64_t, BagTopic> topics_;
  std::string unpacked_;
  std::int64_t id_ = 0;  // of the last message
  std::int64_t last_id_ = 0;
};

}  // namespace psi_slam
