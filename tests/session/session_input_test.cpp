// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_input.h"

#include <gmock/gmock.h>

#include <atomic>
#include <filesystem>

#include "psi_slam/mapping_session.h"
#include "room_log.h"
#include "session/session_file.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class ShortenedLog : public testing::Test {
 protected:
  void shorten() const { std::filesystem::resize_file(log_, std::filesystem::file_size(log_) / 2); }

  TemporaryFolder folder_;
  const std::filesystem::path log_ = write_lines(folder_.path() / "room.log", room_log_lines(60));
  const std::filesystem::path saved_ = folder_.path() / "saved.session";
  Settings settings_;
  const std::atomic<bool> go_on_{false};
};

TEST_F(ShortenedLog, is_refused_when_it_is_opened_again) {
  const SessionInput input(log_);
  input.open(log_options(settings_));
  shorten();
  EXPECT_EQ(
      sentence_of([&] { input.open(log_options(settings_)); }),
      log_.string() + " became shorter while it was read, expected a log that is complete. Fetch it again");
}

TEST_F(ShortenedLog, is_not_taken_for_the_log_of_a_saved_session) {
  MappingSession session(log_, settings_);
  session.run(go_on_);
  shorten();
  EXPECT_THAT(
      session.save(saved_).remark,
      HasSubstr("room.log is no longer readable or became shorter, so the session cannot be resumed"));
  EXPECT_EQ(read_session_file(saved_).facts.logs.at(0).sha256, "");
}

}  // namespace
}  // namespace psi_slam
