// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/growing_database.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "bag_files.h"
#include "logs/rosbag/sqlite_connection.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

/// A database that a recorder writes in a journal mode, the parameter.
class GrowingDatabaseTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    recorder_.emplace(path_, std::vector<std::string>{std::string("journal_mode=") + GetParam()});
    recorder_->create_tables();
    database_.emplace(path_);
  }

  void add(int messages) {
    for (int i = 0; i < messages; ++i) recorder_->add(static_mount(), std::string(500, 'x'));
  }
  void record(int messages) {
    recorder_->begin();
    add(messages);
    recorder_->commit();
  }
  int count() {
    const SqliteConnection connection("bag", database_->vfs_name(), 1000);
    const SqliteStatement rows = connection.prepare("SELECT count(*) FROM messages");
    connection.step(rows);
    return sqlite3_column_int(rows.get(), 0);
  }
  static bool is_wal() { return std::string(GetParam()) == "WAL"; }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "run_0.db3";
  std::optional<Db3Writer> recorder_;
  std::optional<GrowingDatabase> database_;
};

TEST_P(GrowingDatabaseTest, knows_whether_it_was_written_meanwhile) {
  record(20);
  ASSERT_TRUE(database_->begin());
  EXPECT_FALSE(database_->is_empty());
  EXPECT_EQ(count(), 20);
  EXPECT_TRUE(database_->is_unchanged());
  record(1);
  EXPECT_FALSE(database_->is_unchanged());
  ASSERT_TRUE(database_->begin());
  EXPECT_EQ(count(), 21);
  EXPECT_TRUE(database_->is_unchanged());
}

TEST_P(GrowingDatabaseTest, has_the_last_commit_while_the_recorder_prepares_the_next_one) {
  record(20);
  recorder_->begin("IMMEDIATE");
  add(1);
  ASSERT_TRUE(database_->begin());
  EXPECT_EQ(count(), 20);
  EXPECT_TRUE(database_->is_unchanged());
  recorder_->commit();
  EXPECT_FALSE(database_->is_unchanged());
}

TEST_P(GrowingDatabaseTest, is_not_read_while_the_recorder_changes_the_file) {
  record(20);
  ASSERT_TRUE(database_->begin());
  recorder_->begin("EXCLUSIVE");
  add(1);
  EXPECT_EQ(database_->is_unchanged(), is_wal()) << "in WAL mode the file does not change";
  EXPECT_EQ(database_->begin(), is_wal());
  recorder_->commit();
  EXPECT_TRUE(database_->begin());
  EXPECT_EQ(count(), 21);
}

TEST_P(GrowingDatabaseTest, outlives_the_recorder) {
  for (int i = 0; i < 200; ++i) record(20);  // in WAL mode the log begins again meanwhile
  ASSERT_TRUE(database_->begin());
  recorder_.reset();
  EXPECT_EQ(database_->is_unchanged(), !is_wal()) << "the log was moved to the file";
  ASSERT_TRUE(database_->begin());
  EXPECT_EQ(count(), 4000);
  EXPECT_TRUE(database_->is_unchanged());
}

INSTANTIATE_TEST_SUITE_P(Modes, GrowingDatabaseTest, testing::Values("MEMORY", "DELETE", "WAL"),
                         [](const auto& mode) { return std::string(mode.param); });

}  // namespace
}  // namespace psi_slam
