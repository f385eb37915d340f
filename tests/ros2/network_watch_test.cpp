// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/network_watch.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "bag_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeUs kStart_us = 1'700'000'000'000'000;

class NetworkWatchTest : public testing::Test {
 protected:
  NetworkWatchTest() {
    BagPlan plan;
    plan.scan_topics = {"/scan"};
    plan.has_odometry = true;
    plan.transform_topics = {"/tf"};
    plan.odom_frame = "odom";
    plan.base_frame = "base_link";
    watch_.set_plan(plan);
  }

  TimeUs stamp_us() const { return kStart_us + static_cast<TimeUs>(now_s_ * 1e6); }

  void send_scan(std::uint64_t publisher = 1, double stamp_ahead_s = 0) {
    RecordedScan scan;
    scan.time_us = stamp_us() + static_cast<TimeUs>(stamp_ahead_s * 1e6);
    scan.ranges_m = {1, 2, 3};
    watch_.take({{scan.topic, "sensor_msgs/LaserScan", BagEncoding::kCdr, 0}, publisher, cdr(Recorded(scan))},
                now_s_, stamp_us());
  }

  void send_transform(const std::string& parent, const std::string& child, std::uint64_t publisher = 2,
                      double late_s = 0) {
    RecordedPose pose;
    pose.topic = "/tf";
    pose.time_us = stamp_us() - static_cast<TimeUs>(late_s * 1e6);
    pose.frame = parent;
    pose.child_frame = child;
    watch_.take({{"/tf", "tf2_msgs/TFMessage", BagEncoding::kCdr, 0}, publisher, cdr(Recorded(pose))}, now_s_,
                stamp_us());
  }

  /// Lets time pass, with scans and odometry ten times a second if they are wanted.
  void pass(double duration_s, bool scans = true, bool odometry = true) {
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s; now_s_ += 0.1) {
      if (odometry) send_transform("odom", "base_link");
      if (scans) send_scan();
      watch_.pass_time(now_s_);
    }
  }

  double now_s_ = 100;
  std::vector<std::string> sentences_;
  NetworkWatch watch_{{[] { return std::string("what there is"); },
                       [](std::uint64_t publisher) { return "/node" + std::to_string(publisher); }},
                      "map",
                      [this](const std::string& sentence) { sentences_.push_back(sentence); }};
};

TEST_F(NetworkWatchTest, SaysNothingWhileAllIsWell) {
  pass(30);
  EXPECT_THAT(sentences_, IsEmpty());
}

TEST_F(NetworkWatchTest, TellsOnceThatScansStopAndOnceThatTheyComeAgain) {
  pass(2);
  pass(12, false);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("no scan for 5 s: what there is")));
  sentences_.clear();
  pass(2);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("scans have resumed after 12")));
  sentences_.clear();
  pass(6, false);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("no scan for 5 s")));
}

TEST_F(NetworkWatchTest, TellsThatOdometryStops) {
  pass(2);
  pass(10, true, false);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("no odometry for 5 s")));
}

TEST_F(NetworkWatchTest, DistinguishesLateOdometryFromStoppedOdometry) {
  pass(2);
  for (int i = 0; i < 100; ++i, now_s_ += 0.1) {
    send_transform("odom", "base_link", 2, 3.5);
    send_scan();
    watch_.pass_time(now_s_);
  }
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("3.5 s behind")));
}

TEST_F(NetworkWatchTest, NamesBothNodesThatPublishOdometry) {
  pass(2);
  for (int i = 0; i < 50; ++i, now_s_ += 0.1) {
    send_transform("odom", "base_link", 2);
    send_transform("odom", "base_link", 3);
    send_scan();
    watch_.pass_time(now_s_);
  }
  EXPECT_THAT(sentences_,
              ElementsAre(testing::AllOf(HasSubstr("/node2 and /node3"), HasSubstr("odom to base_link"))));
}

TEST_F(NetworkWatchTest, DoesNotTakeARestartForASecondNode) {
  pass(2);
  pass(6, true, false);
  for (int i = 0; i < 50; ++i, now_s_ += 0.1) {
    send_transform("odom", "base_link", 3);
    send_scan();
    watch_.pass_time(now_s_);
  }
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("no odometry for 5 s"), HasSubstr("restarted: /node3")));
}

TEST_F(NetworkWatchTest, NamesASecondProgramThatPublishesThePoseInTheMap) {
  pass(1);
  send_transform("map", "odom", 9);
  send_transform("map", "odom", 9);
  send_transform("map", "floor", 8);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("/node9 also publishes the transform from map to odom")));
}

TEST_F(NetworkWatchTest, TellsClocksApartFromPlayedLogs) {
  for (int i = 0; i < 30; ++i) send_scan(1, 42);
  EXPECT_THAT(sentences_, ElementsAre(testing::AllOf(HasSubstr("42 s after"), HasSubstr("chrony"))));
  sentences_.clear();
  for (int i = 0; i < 30; ++i) send_scan();
  for (int i = 0; i < 30; ++i) send_scan(1, -864'000);
  EXPECT_THAT(sentences_, ElementsAre(testing::AllOf(HasSubstr("10 days before"), HasSubstr("played"))));
}

TEST_F(NetworkWatchTest, TellsThatTheDriverWasStartedAgain) {
  pass(2);
  now_s_ += 2;
  send_scan(7);
  EXPECT_THAT(sentences_, ElementsAre(HasSubstr("publisher of /scan was restarted: /node7")));
}

TEST_F(NetworkWatchTest, IgnoresDamagedMessages) {
  watch_.take({{"/scan", "sensor_msgs/LaserScan", BagEncoding::kCdr, 0}, 1, std::string("\0\1\0\0", 4)},
              now_s_, stamp_us());
  EXPECT_THAT(sentences_, IsEmpty());
}

}  // namespace
}  // namespace psi_slam
