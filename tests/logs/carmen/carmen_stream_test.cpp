// SPDX-License-Identifier: BSD-3-Clause
#include "logs/carmen/carmen_stream.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "psi_slam/user_error.h"
#include "same_frames.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// Sends a text in pieces of varying size, and counts the bytes that were taken.
class Pieces : public ByteSource {
 public:
  explicit Pieces(std::string text, std::size_t* taken = nullptr) : text_(std::move(text)), taken_(taken) {}

  std::size_t read(char* bytes, std::size_t size) override {
    size_ = size_ % 701 + 97;
    const std::size_t done = text_.copy(bytes, std::min(size, size_), at_);
    at_ += done;
    if (taken_ != nullptr) *taken_ = at_;
    return done;
  }
  const std::filesystem::path& path() const override { return path_; }
  double progress() const override { return 0; }

 private:
  std::string text_;
  std::size_t* taken_;
  std::filesystem::path path_ = "pieces";
  std::size_t at_ = 0;
  std::size_t size_ = 0;
};

/// Returns `format` with the position in place of $ and the time in place of @.
std::string line_of(const std::string& format, double time_s, double x_m) {
  std::string line;
  for (const char c : format)
    if (c == '$')
      line += fixed_text(x_m, 3);
    else if (c == '@')
      line += fixed_text(time_s, 6);
    else
      line += c;
  return line + " host 1\n";
}

const std::string kFlaser = "FLASER 3 1.5 2.25 60 $ 0.5 0.1 $ 0.5 0.1 @";
const std::string kRlaser = "RLASER 3 3 2 1 $ 0 0 $ 0 0 @";
const std::string kRawlaser1 = "RAWLASER1 0 -1.57 3.14 1.57 30 0.01 0 2 1 $ 1 $ @";
const std::string kRobotlaser =
    "ROBOTLASER1 0 -1.57 3.14 1.57 30 0.01 0 3 1 2 3 0 $ 0 0.1 $ 0 0.1 0 0 0 0 0 @";
const std::string kOdom = "ODOM $ $ 0.2 0 0 0 @";

/// A log of 200 scans, five a second, in which each format of `lines` appears for each scan.
std::string log_of(const std::vector<std::string>& lines, const std::string& head = "") {
  std::string text = head;
  for (int i = 0; i < 200; ++i)
    for (std::size_t kind = 0; kind < lines.size(); ++kind)
      text += line_of(lines[kind], 100 + 0.2 * i + 0.03 * static_cast<double>(kind), 0.05 * i);
  return text;
}

/// Options that state the field of view, which three readings do not show.
LogOptions half_circle() {
  LogOptions options;
  options.field_of_view_rad = M_PI;
  return options;
}

class CarmenStreamTest : public testing::Test {
 protected:
  std::unique_ptr<LogReader> stream(const std::string& text, double look_over_s = 5,
                                    const LogOptions& options = half_circle()) {
    return open_carmen_stream(std::make_unique<Pieces>(text, &taken_), options, look_over_s);
  }

  void expect_as_file(const std::string& text, const LogOptions& options = half_circle()) {
    SCOPED_TRACE(text.substr(0, 300));
    const auto file = folder_.path() / "log.clf";
    write_file(file, text);
    const auto log = open_carmen_log(file, options);
    const auto live = stream(text, 5, options);
    EXPECT_GE(expect_same_frames(*live, *log), 200U);
    EXPECT_EQ(live->contents().messages, log->contents().messages);
    EXPECT_EQ(live->contents().laser, log->contents().laser);
    EXPECT_EQ(live->assumptions(), log->assumptions());
  }

  TemporaryFolder folder_;
  std::size_t taken_ = 0;
};

TEST_F(CarmenStreamTest, gives_the_frames_of_a_file_to_the_last_bit) {
  const std::string mounts =
      "# comment\nPARAM robot_frontlaser_offset 0.3 nav 1 host 1\nPARAM robot_rearlaser_offset -0.2 nav 1 "
      "host 1\n";
  expect_as_file(log_of({kFlaser}));
  expect_as_file(log_of({kFlaser, kOdom}, mounts));
  expect_as_file(log_of({kRobotlaser, kFlaser}));
  expect_as_file(log_of({kRawlaser1, kOdom}));
  expect_as_file(log_of({kOdom, kRawlaser1, kOdom}));
  expect_as_file(log_of({kRawlaser1}));
  expect_as_file(log_of({kFlaser, kRlaser}, mounts));
  LogOptions rear = half_circle();
  rear.laser = "rear";
  expect_as_file(log_of({kFlaser, kRlaser}, mounts), rear);
  LogOptions without_odometry = half_circle();
  without_odometry.odometry = "none";
  expect_as_file(log_of({kRawlaser1, kOdom}), without_odometry);
}

TEST_F(CarmenStreamTest, decides_by_the_first_seconds_of_scans) {
  const std::string log = log_of({kFlaser});
  stream(log, 0);
  EXPECT_LT(taken_, log.size() / 20) << "the first scan is enough";
  stream(log, 5);
  EXPECT_GT(taken_, log.size() / 10);
  EXPECT_LT(taken_, log.size() / 5) << "5 of 40 s";
  stream(log, 1000);
  EXPECT_EQ(taken_, log.size()) << "fewer than 500 lines";
}

TEST_F(CarmenStreamTest, decides_by_500_lines_if_time_stands_still) {
  std::string log;
  for (int i = 0; i < 2000; ++i) log += line_of(kFlaser, 100, 0);
  stream(log, 5);
  EXPECT_LT(taken_, log.size() / 3);
}

TEST_F(CarmenStreamTest, expects_no_odometry_that_did_not_come_in_the_first_seconds) {
  const auto live = stream(log_of({kRawlaser1}) + log_of({kOdom}));
  const auto first = live->next();
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->has_odometry);
  EXPECT_LT(taken_, log_of({kRawlaser1}).size() / 2) << "scans do not wait for odometry";
  while (live->next()) {
  }
  ASSERT_THAT(live->assumptions(), testing::SizeIs(1));
  EXPECT_THAT(live->assumptions()[0], HasSubstr("no ODOM line came in the first seconds"));
}

TEST_F(CarmenStreamTest, continues_if_odometry_stops) {
  const auto live = stream(log_of({kRawlaser1, kOdom}) + log_of({kRawlaser1}));
  std::size_t scans = 0;
  while (live->next()) ++scans;
  EXPECT_EQ(scans, 400U);
}

TEST_F(CarmenStreamTest, skips_any_number_of_damaged_messages) {
  std::string log;
  for (int i = 0; i < 300; ++i)
    log += line_of(kFlaser, 100 + i, 0) + "FLASER 3 1 2\nFLASER x\n\x01\x02 garbage\n\nODOM 1\n";
  const auto live = stream(log + "FLASER 3 1 2");
  std::size_t scans = 0;
  while (live->next()) ++scans;
  EXPECT_EQ(scans, 300U);
  EXPECT_EQ(live->skipped_lines().count, 601U);
  EXPECT_THAT(live->skipped_lines().first, HasSubstr("pieces:2: FLASER"));
}

TEST_F(CarmenStreamTest, keeps_repeated_and_late_scans_in_their_order) {
  const std::string first = line_of(kFlaser, 100, 0);
  const std::string second = line_of(kFlaser, 101, 0.1);
  const auto live = stream(first + second + second + first);
  std::vector<TimeUs> times_us;
  while (const auto frame = live->next()) times_us.push_back(frame->time_us);
  EXPECT_THAT(times_us, testing::ElementsAre(100'000'000, 101'000'000, 101'000'000, 100'000'000));
}

TEST_F(CarmenStreamTest, forgets_old_lines_while_there_are_no_scans) {
  const std::string mount = "PARAM robot_frontlaser_offset 0.3 nav 1 host 1\n";
  std::string garbage;
  for (int i = 0; i < 40; ++i) garbage += std::string(1'000'000, static_cast<char>('a' + i % 26)) + '\n';
  const auto live = stream(mount + garbage + log_of({kFlaser}));
  std::size_t scans = 0;
  while (const auto frame = live->next()) {
    EXPECT_EQ(frame->scan.robot_T_laser.x, 0.3) << "PARAM lines are kept";
    ++scans;
  }
  EXPECT_EQ(scans, 200U);
  EXPECT_LE(live->contents().messages.at("unknown"), 16U) << "MB";
}

TEST_F(CarmenStreamTest, counts_only_some_names_of_messages) {
  std::string log;
  for (int i = 0; i < 1000; ++i) log += "NAME" + std::to_string(i) + " 1\n";
  const auto live = stream(log_of({kFlaser, kOdom}) + log);
  while (live->next()) {
  }
  const auto& messages = live->contents().messages;
  EXPECT_EQ(messages.size(), 23U) << "FLASER, ODOM, 20 others, and unknown ones";
  EXPECT_EQ(messages.at("NAME0"), 1U);
  EXPECT_EQ(messages.at("unknown"), 980U);
}

TEST_F(CarmenStreamTest, awaits_lasers_that_the_user_names) {
  const std::string mounts =
      "PARAM robot_frontlaser_offset 0.3 nav 1 host 1\nPARAM robot_rearlaser_offset -0.2 nav 1 host 1\n";
  LogOptions both = half_circle();
  both.laser = "front,rear";
  for (const int rear_from : {12, 35}) {
    std::string log = mounts;
    for (int i = 0; i < 200; ++i) {
      log += line_of(kFlaser, 100 + 0.2 * i, 0);
      if (i >= 5 * rear_from) log += line_of(kRlaser, 100.05 + 0.2 * i, 0);
    }
    const auto live = stream(log, 5, both);
    EXPECT_EQ(live->assumptions().size(), rear_from == 35 ? 1U : 0U);
    std::size_t rear_scans = 0;
    while (const auto frame = live->next())
      if (frame->scan.laser == 1) ++rear_scans;
    EXPECT_EQ(rear_scans, static_cast<std::size_t>(200 - 5 * rear_from));
  }
}

TEST_F(CarmenStreamTest, a_stream_without_scans_is_an_error) {
  for (const std::string text : {"", "ODOM 0 0 0 0 0 0 1 host 1\n"}) {
    try {
      stream(text)->next();
      ADD_FAILURE() << "expected a UserError";
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr("pieces has no laser scans"));
    }
  }
}

}  // namespace
}  // namespace psi_slam
