// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/begun_bag.h"

#include <gmock/gmock.h>

#include <string>

#include "bag_files.h"
#include "log_files.h"
#include "logs/frames/look_over.h"
#include "logs/rosbag/rosbag_stream.h"
#include "same_frames.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

TEST(BeginningOfBag, has_the_topics_in_the_order_of_the_complete_bag) {
  // The recorder creates the topics of the robot /a first, but the robot /b speaks first.
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "run.db3";
  write_db3(path, [] {
    Recording recording;
    for (Recorded message : recorded_run()) {
      if (topic_of(message) == "/tf_static") continue;
      for (const char* robot : {"/a", "/b"}) {
        Recorded own = message;
        std::visit([&](auto& one) { one.topic = robot + one.topic; }, own);
        recording.push_back(own);
      }
    }
    return recording;
  }());
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, "DELETE FROM messages WHERE id IN (1, 3)", nullptr, nullptr, nullptr),
            SQLITE_OK);
  ASSERT_EQ(sqlite3_changes(database), 2);
  sqlite3_close(database);

  BagRecorder recorder;
  recorder.should_stop = [] { return false; };
  recorder.wait = [](double) { return false; };
  const auto live =
      open_followed_bag(std::make_unique<BagRecording>(BagRecording{path, follow_sqlite_bag(path, recorder)}),
                        {}, kUsualLookOver_s);
  const auto whole = open_log_reader(path, {});
  EXPECT_EQ(whole->contents().laser, "/a/scan");
  EXPECT_EQ(live->contents().laser, "/a/scan");
  EXPECT_GT(expect_same_frames(*live, *whole), 15U);
}

}  // namespace
}  // namespace psi_slam
