// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/gyroscope_choice.h"

#include "test_files.h"

namespace psi_slam {
namespace {

constexpr const char* kExpected = "a gyroscope of my.bag";

LogOptions with_imu(const std::string& imu) {
  LogOptions options;
  options.imu = imu;
  return options;
}

TEST(GyroscopeChoice, auto_takes_the_only_gyroscope) {
  for (const char* text : {"auto", ""}) {
    const GyroscopeChoice one = choose_gyroscope(with_imu(text), {"/imu"}, false, kExpected);
    EXPECT_EQ(one.name, "/imu");
    EXPECT_EQ(one.assumption, "");
    const GyroscopeChoice none = choose_gyroscope(with_imu(text), {}, false, kExpected);
    EXPECT_FALSE(none.name);
    EXPECT_EQ(none.assumption, "");
    EXPECT_FALSE(choose_gyroscope(with_imu(text), {"/imu"}, true, kExpected).name) << "odometry is better";
  }
}

TEST(GyroscopeChoice, auto_takes_none_of_several) {
  const GyroscopeChoice choice = choose_gyroscope(with_imu("auto"), {"/a", "/b"}, false, kExpected);
  EXPECT_FALSE(choice.name);
  EXPECT_EQ(choice.assumption,
            "no gyroscope predicts the heading, because the log has several: \"/a\", \"/b\". Choose one with "
            "log.imu");
}

TEST(GyroscopeChoice, a_named_gyroscope_must_exist_and_be_needed) {
  EXPECT_EQ(choose_gyroscope(with_imu("/b"), {"/a", "/b"}, false, kExpected).name, "/b");
  EXPECT_EQ(sentence_of([] {
              choose_gyroscope(with_imu("/c"), {"/a", "/b"}, false, kExpected);
            }),
            "log.imu is \"/c\", expected a gyroscope of my.bag: \"/a\", \"/b\"");
  EXPECT_EQ(sentence_of([] { choose_gyroscope(with_imu("/c"), {}, true, kExpected); }),
            "log.imu is \"/c\", expected a gyroscope of my.bag: it has none. Map without a gyroscope with "
            "log.imu=none");
  const GyroscopeChoice unused = choose_gyroscope(with_imu("/b"), {"/b"}, true, kExpected);
  EXPECT_FALSE(unused.name);
  EXPECT_EQ(unused.assumption,
            "the gyroscope of \"/b\" is not used, because the log has odometry. Ignore the odometry with "
            "log.odometry=none");
}

TEST(GyroscopeChoice, none_takes_no_gyroscope) {
  const GyroscopeChoice choice = choose_gyroscope(with_imu("none"), {"/a", "/b"}, false, kExpected);
  EXPECT_FALSE(choice.name);
  EXPECT_EQ(choice.assumption, "");
}

}  // namespace
}  // namespace psi_slam
