// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rawlog/observation_stream.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "log_files.h"
#include "rawlog_files.h"
#include "same_frames.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr TimeUs kBegin = 1'464'602'099'000'000;
constexpr TimeUs kSecond = 1'000'000;

/// Sends objects, and counts those that were taken.
class Objects : public ObjectSource {
 public:
  Objects(RawlogObjects objects, std::size_t* taken) : objects_(std::move(objects)), taken_(taken) {}

  mrpt::serialization::CSerializable::Ptr next() override {
    return *taken_ < objects_.size() ? std::move(objects_[(*taken_)++]) : nullptr;
  }
  std::string place() const override { return "sensors: object " + std::to_string(*taken_); }
  const std::filesystem::path& path() const override { return path_; }
  double progress() const override { return 0; }

 private:
  RawlogObjects objects_;
  std::size_t* taken_;
  std::filesystem::path path_ = "sensors";
};

class ObservationStreamTest : public testing::Test {
 protected:
  std::unique_ptr<LogReader> stream(RawlogObjects objects, const std::string& lasers = "") {
    LogOptions options;
    options.laser = lasers;
    return open_observation_stream(std::make_unique<Objects>(std::move(objects), &taken_), options, 5);
  }

  std::size_t taken_ = 0;
};

/// Scans of a laser, ten a second, from the second `from` to the second `to`.
RawlogObjects scans(const std::string& label, int from, int to) {
  RawlogObjects objects;
  for (int i = 10 * from; i < 10 * to; ++i) {
    const auto scan = range_scan(kBegin + i * kSecond / 10, label);
    if (label == "REAR") scan->sensorPose = mrpt::poses::CPose3D(-0.2, 0, 0, M_PI, 0, 0);
    objects.push_back(scan);
  }
  return objects;
}

RawlogObjects joined(RawlogObjects first, const RawlogObjects& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Bytes of a rawlog with pairs of actions and sensory frames, ten a second.
std::string bytes_of_rawlog(int seconds) {
  RawlogObjects objects;
  for (int i = 0; i < 10 * seconds; ++i) {
    objects.push_back(movement(mrpt::poses::CPose2D(0.1, 0, 0.01)));
    objects.push_back(sensory_frame({range_scan(kBegin + i * kSecond / 10)}));
  }
  const TemporaryFolder folder;
  write_rawlog(folder.path() / "run.rawlog", objects, false);
  return read_file(folder.path() / "run.rawlog");
}

std::unique_ptr<LogReader> stream_of(const std::string& bytes) {
  return open_rawlog_stream(
      std::make_unique<TextSource>(std::make_shared<const std::string>(bytes), "run.rawlog"), {}, 5);
}

TEST(RawlogStream, has_the_frames_of_the_complete_rawlog) {
  const TemporaryFolder folder;
  const std::string bytes = bytes_of_rawlog(8);
  write_file(folder.path() / "run.rawlog", bytes);
  const auto whole = open_rawlog(folder.path() / "run.rawlog", {});
  EXPECT_EQ(expect_same_frames(*stream_of(bytes), *whole), 80U);
}

TEST(RawlogStream, ends_where_the_bytes_end) {
  const std::string bytes = bytes_of_rawlog(2);
  const auto expected = all_frames(*stream_of(bytes));
  ASSERT_EQ(expected.size(), 20U);
  std::size_t most = 0;
  for (std::size_t size = bytes.size() / 2; size < bytes.size(); size += 13) {
    const std::size_t frames = all_frames(*stream_of(bytes.substr(0, size))).size();
    EXPECT_GE(frames, most) << size << " bytes";
    most = frames;
  }
  EXPECT_EQ(most, 19U) << "the last object is incomplete";
}

TEST(RawlogStream, counts_scans_within_sensory_frames) {
  // 6,000 sensory frames and 6,000 actions: actions would be dropped if they were no part of the beginning.
  const auto reader = stream_of(bytes_of_rawlog(600));
  const auto frames = all_frames(*reader);
  ASSERT_EQ(frames.size(), 6000U);
  EXPECT_GT(frames[1].odom_T_robot.norm(), 0.05);
}

TEST_F(ObservationStreamTest, is_looked_over_for_some_seconds) {
  const auto reader = stream(scans("FRONT", 0, 60));
  EXPECT_EQ(taken_, 51U);
  EXPECT_EQ(all_frames(*reader).size(), 600U);
}

TEST_F(ObservationStreamTest, forgets_old_observations_while_there_are_no_scans) {
  RawlogObjects objects;
  for (int i = 0; i < 30'000; ++i) objects.push_back(odometry(kBegin + i, {1.0 * i, 0, 0}));
  const std::weak_ptr<mrpt::serialization::CSerializable> oldest = objects.front();
  const auto reader = stream(joined(std::move(objects), scans("FRONT", 1, 20)));
  EXPECT_TRUE(oldest.expired());
  const auto frames = all_frames(*reader);
  ASSERT_EQ(frames.size(), 190U);
  EXPECT_EQ(frames.front().odom_T_robot.x, 29'999) << "the latest odometry is kept";
}

TEST_F(ObservationStreamTest, awaits_a_laser_that_the_user_names) {
  const auto objects = joined(scans("FRONT", 0, 12), joined(scans("REAR", 12, 13), scans("FRONT", 13, 60)));
  const auto reader = stream(objects, "FRONT,REAR");
  EXPECT_EQ(taken_, 121U);
  EXPECT_THAT(reader->assumptions(), SizeIs(0));
  EXPECT_EQ(all_frames(*reader).size(), 600U);
}

TEST_F(ObservationStreamTest, reads_a_named_laser_that_comes_late) {
  const auto reader = stream(joined(scans("FRONT", 0, 40), scans("REAR", 40, 50)), "FRONT,REAR");
  EXPECT_EQ(taken_, 301U) << "30 s";
  ASSERT_THAT(reader->assumptions(), SizeIs(1));
  EXPECT_THAT(reader->assumptions()[0], HasSubstr("log.laser names the laser \"REAR\""));
  const auto frames = all_frames(*reader);
  ASSERT_EQ(frames.size(), 500U);
  EXPECT_EQ(frames.back().scan.laser, 1U);
}

TEST_F(ObservationStreamTest, one_named_laser_must_come) {
  EXPECT_THAT(sentence_of([&] { stream(scans("FRONT", 0, 60), "FRNT"); }),
              HasSubstr("log.laser is \"FRNT\", expected the label of a laser of sensors: \"FRONT\""));
}

TEST_F(ObservationStreamTest, skips_any_number_of_invalid_observations) {
  RawlogObjects objects;
  for (int i = 0; i < 50; ++i) {
    auto tilted = range_scan(kBegin + i, "FRONT");
    tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 1, 0);
    objects.push_back(tilted);
  }
  const auto reader = stream(joined(objects, scans("FRONT", 1, 10)));
  EXPECT_EQ(all_frames(*reader).size(), 90U);
  EXPECT_EQ(reader->skipped_lines().count, 50U);
  taken_ = 0;
  const auto damaged = stream(objects);
  EXPECT_THAT(sentence_of([&] { damaged->next(); }), HasSubstr("sensors: object"));
}

}  // namespace
}  // namespace psi_slam
