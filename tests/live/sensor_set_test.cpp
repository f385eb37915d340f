// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_set.h"

#include <gmock/gmock.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

#include "hokuyo_emulator.h"
#include "live/live_source.h"
#include "lms100_emulator.h"
#include "psi_slam/open_log.h"
#include "rplidar_emulator.h"
#include "sender.h"
#include "shared_logs.h"
#include "temporary_folder.h"
#include "test_files.h"

// CLMS100Eth sleeps 10 s after it has asked whether the laser is ready. This function replaces that of the C
// library, and shortens such pauses.
extern "C" int nanosleep(const timespec* time, timespec* left) {
  constexpr timespec kShort{0, 1'000'000};
  errno = ::clock_nanosleep(CLOCK_MONOTONIC, 0, time->tv_sec < 5 ? time : &kShort, left);
  return errno == 0 ? 0 : -1;
}

namespace psi_slam {

/// A driver of wheels that turn with 1 rad/s.
class SpinningWheels : public mrpt::hwdrivers::CGenericSensor {
  DEFINE_GENERIC_SENSOR(SpinningWheels)
 public:
  void doProcess() override {
    auto odometry = std::make_shared<mrpt::obs::CObservationOdometry>();
    odometry->timestamp = mrpt::Clock::now();
    odometry->sensorLabel = m_sensorLabel;
    const auto now_s = std::chrono::duration<double>(odometry->timestamp.time_since_epoch()).count();
    odometry->odometry = mrpt::poses::CPose2D(0, 0, std::fmod(now_s, 2 * M_PI));
    appendObservation(odometry);
  }

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase&, const std::string&) override {}
};

IMPLEMENTS_GENERIC_SENSOR(SpinningWheels, psi_slam)

/// A driver that gives 6000 readings of an IMU and 6000 of wheels at once, and then nothing.
class Flood : public mrpt::hwdrivers::CGenericSensor {
  DEFINE_GENERIC_SENSOR(Flood)
 public:
  static constexpr int kReadings = 6000;

  void doProcess() override {
    for (int i = 0; i < kReadings && !is_done_; ++i) {
      add<mrpt::obs::CObservationIMU>();
      add<mrpt::obs::CObservationOdometry>();
    }
    is_done_ = true;
  }

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase&, const std::string&) override {}

 private:
  template <class Observation>
  void add() {
    auto observation = std::make_shared<Observation>();
    observation->timestamp = mrpt::Clock::now();
    appendObservation(observation);
  }

  bool is_done_ = false;
};

IMPLEMENTS_GENERIC_SENSOR(Flood, psi_slam)

namespace {

using mrpt::obs::CObservation2DRangeScan;
using testing::AllOf;
using testing::HasSubstr;

constexpr double kIdle_s = 60;  // a lost scan fails a test instead of stopping it

/// Ranges that tell which scan they belong to, whole millimetres.
std::vector<float> numbered_ranges(std::size_t number, std::size_t beams = HokuyoEmulator::kBeams) {
  std::vector<float> ranges_m(beams, 2.0F);
  ranges_m[0] = 1.0F + 0.001F * static_cast<float>(number);
  ranges_m[1] = 0.0F;
  return ranges_m;
}

std::size_t number_of(const CObservation2DRangeScan& scan) {
  return static_cast<std::size_t>(std::lround((scan.getScanRange(0) - 1.0F) * 1000));
}

class SensorSetTest : public testing::Test {
 protected:
  LiveControl control() {
    return {[this] { return stop_.load(); }, [this](const std::string& notice) { notices_.add(notice); }};
  }

  std::filesystem::path settings(const std::string& text) const {
    const auto file = folder_.path() / "sensors.ini";
    write_file(file, text);
    return file;
  }

  std::string hokuyo_settings() const {
    return "[FRONT]\ndriver = CHokuyoURG\nsensorLabel = HOKUYO\nprocess_rate = 500\ncomms_timeout_ms = 30\n"
           "maxMissedScansToDeclareError = 300\n"
           "COM_port_LIN = " +
           port_.string() + "\npose_x = 0.25\npose_yaw = 90\ndisable_firmware_timestamp = true\n";
  }

  static std::string lms100_settings(int port) {
    return "[SICK]\ndriver = CLMS100Eth\nprocess_rate = 500\nip_address = 127.0.0.1\nTCP_port = " +
           std::to_string(port) + '\n';
  }

  std::string rplidar_settings() const {
    return "[ROUND]\ndriver = CRoboPeakLidar\nprocess_rate = 500\nsensorLabel = ROUND\nCOM_port_LIN = " +
           port_.string() + '\n';
  }

  /// Reads scans until one has this number, and returns the numbers of all.
  static std::vector<std::size_t> numbers_until(SensorSet& sensors, std::size_t last) {
    std::vector<std::size_t> numbers;
    while (numbers.empty() || numbers.back() != last) {
      const auto object = sensors.next();
      const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(object.get());
      if (scan == nullptr) {
        ADD_FAILURE() << "no scan with number " << last;
        break;
      }
      numbers.push_back(number_of(*scan));
    }
    return numbers;
  }

  /// As numbers_until(), but only the last four: on a busy computer a driver may restart its laser.
  static std::vector<std::size_t> last_numbers_until(SensorSet& sensors, std::size_t last) {
    std::vector<std::size_t> numbers = numbers_until(sensors, last);
    if (numbers.size() > 4) numbers.erase(numbers.begin(), numbers.end() - 4);
    return numbers;
  }

  TemporaryFolder folder_;
  std::filesystem::path port_ = folder_.path() / "ttyLASER";
  Notices notices_;
  std::atomic<bool> stop_ = false;
};

TEST_F(SensorSetTest, reads_a_hokuyo_with_garbage_and_repeated_scans) {
  const HokuyoEmulator laser(port_, {{numbered_ranges(1), ""},
                                     {{}, "MD00 garbage \x01\x7f\n\n"},
                                     {numbered_ranges(2), ""},
                                     {numbered_ranges(2), ""},
                                     {numbered_ranges(3), ""}});
  SensorSet sensors(settings(hokuyo_settings()), control(), kIdle_s);
  EXPECT_THAT(last_numbers_until(sensors, 3), testing::ElementsAre(1, 2, 2, 3));
  EXPECT_THAT(notices_.text(), HasSubstr("sensor [FRONT] sends data"));
  EXPECT_THAT(sensors.place(), HasSubstr("sensors.ini: observation "));
  stop_ = true;
  EXPECT_EQ(sensors.next(), nullptr);
}

TEST_F(SensorSetTest, a_hokuyo_may_be_unplugged_for_some_time) {
  auto laser = std::make_unique<HokuyoEmulator>(
      port_, std::vector<HokuyoEmulator::Message>{
                 {numbered_ranges(1), ""}, {numbered_ranges(2), ""}, {{}, "MD0000"}});
  SensorSet sensors(settings(hokuyo_settings()), control(), kIdle_s);
  numbers_until(sensors, 2);
  laser.reset();
  EXPECT_TRUE(soon([&] { return notices_.text().find("sensor [FRONT] failed") != std::string::npos; }))
      << notices_.text();
  laser =
      std::make_unique<HokuyoEmulator>(port_, std::vector<HokuyoEmulator::Message>{{numbered_ranges(7), ""}});
  numbers_until(sensors, 7);
  stop_ = true;
}

TEST_F(SensorSetTest, waits_for_a_sensor_that_is_not_there_yet) {
  SensorSet sensors(settings(hokuyo_settings()), control(), 0.0);
  EXPECT_EQ(sensors.next(), nullptr) << "nothing came for 0 s";
  EXPECT_TRUE(soon([&] { return notices_.text().find("sensor [FRONT] failed") != std::string::npos; }));
  EXPECT_THAT(notices_.text(), AllOf(HasSubstr("Error trying to open the serial port"),
                                     HasSubstr("It is started again every second")));
}

TEST_F(SensorSetTest, reads_an_lms100_that_is_switched_off_and_on) {
  constexpr std::size_t kBeams = 541;
  using Messages = std::vector<Lms100Emulator::Message>;
  auto laser = std::make_unique<Lms100Emulator>(Messages{{numbered_ranges(1, kBeams), ""},
                                                         {{}, "\x02sFA 4\x03"},
                                                         {{}, "garbage"},
                                                         {numbered_ranges(2, kBeams), ""},
                                                         {numbered_ranges(2, kBeams), ""},
                                                         {numbered_ranges(3, kBeams), ""}});
  const std::uint16_t port = laser->port();
  SensorSet sensors(settings(lms100_settings(port)), control(), kIdle_s);
  EXPECT_THAT(last_numbers_until(sensors, 3), testing::ElementsAre(1, 2, 2, 3));
  laser.reset();
  EXPECT_TRUE(soon([&] { return notices_.text().find("sensor [SICK] failed") != std::string::npos; }))
      << notices_.text();
  laser = std::make_unique<Lms100Emulator>(Messages{{numbered_ranges(7, kBeams), ""}}, port);
  numbers_until(sensors, 7);
  stop_ = true;
}

// The driver keeps only the newest scan, so scans may be missing on a busy computer. Garbage between two
// scans makes some false readings, and may cut a scan in two.
TEST_F(SensorSetTest, reads_an_rplidar_with_garbage_and_repeated_scans_that_may_be_unplugged) {
  if (!RplidarEmulator::kDriverUnderstands) GTEST_SKIP() << RplidarEmulator::kNotUnderstood;
  const auto message = [](float range_m) {
    return RplidarEmulator::Message{std::vector<float>(RplidarEmulator::kBeams, range_m), ""};
  };
  const auto expect_scans_until = [](SensorSet& sensors, const std::vector<float>& ranges_m) {
    std::size_t last_readings = 0;  // of the last scan
    for (float range_m = 0; last_readings < 250;) {
      const auto object = sensors.next();
      const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(object.get());
      ASSERT_NE(scan, nullptr) << "no scan of " << ranges_m.back() << " m";
      std::size_t false_readings = 0;
      last_readings = 0;
      for (std::size_t i = 0; i < scan->getScanSize(); ++i) {
        if (!scan->getScanRangeValidity(i)) continue;
        const float reading_m = scan->getScanRange(i);
        if (std::count(ranges_m.begin(), ranges_m.end(), reading_m) == 0) {
          ++false_readings;
        } else {
          EXPECT_GE(reading_m, range_m) << "scans come in their order";
          range_m = std::max(range_m, reading_m);
          if (reading_m == ranges_m.back()) ++last_readings;
        }
      }
      EXPECT_LE(false_readings, 4U) << "after " << range_m << " m";
    }
  };
  auto laser = std::make_unique<RplidarEmulator>(
      port_, std::vector<RplidarEmulator::Message>{message(1),
                                                   message(2),
                                                   {{}, "garbage \x01\x7f\n\xff\xa5\x5a"},
                                                   message(3),
                                                   message(3),
                                                   {{}, "\xa5\x5a\x05"},
                                                   message(4)});
  SensorSet sensors(settings(rplidar_settings()), control(), kIdle_s);
  expect_scans_until(sensors, {1, 2, 3, 4});
  EXPECT_THAT(notices_.text(), HasSubstr("sensor [ROUND] sends data, but the driver loses the readings"));
  laser.reset();
  EXPECT_TRUE(soon([&] { return notices_.text().find("sensor [ROUND] failed") != std::string::npos; }))
      << notices_.text();
  laser = std::make_unique<RplidarEmulator>(port_, std::vector<RplidarEmulator::Message>{message(5)});
  expect_scans_until(sensors, {4, 5});
  stop_ = true;
}

TEST_F(SensorSetTest, gives_the_readings_of_an_rplidar_their_bearings) {
  if (!RplidarEmulator::kDriverUnderstands) GTEST_SKIP() << RplidarEmulator::kNotUnderstood;
  std::vector<float> ranges_m(RplidarEmulator::kBeams);
  for (std::size_t degree = 0; degree < ranges_m.size(); ++degree)
    ranges_m[degree] = 1.0F + 0.01F * static_cast<float>(degree);
  LiveInput input;
  input.kind = LiveInput::Kind::kSensors;
  input.file = settings(rplidar_settings()).string();
  input.look_over_s = 0;
  input.idle_s = kIdle_s;
  const RplidarEmulator laser(port_, {{ranges_m, ""}});
  const auto frame = open_live(input, {}, control())->next();
  stop_ = true;
  ASSERT_TRUE(frame);
  std::size_t readings = 0;
  for (std::size_t i = 0; i < frame->scan.ranges_m.size(); ++i) {
    if (std::isnan(frame->scan.ranges_m[i])) continue;
    const double clockwise_deg = (static_cast<double>(frame->scan.ranges_m[i]) - 1) * 100;
    const double bearing_deg = 180 - clockwise_deg;  // the driver puts the laser's 0 degrees behind
    EXPECT_NEAR(static_cast<double>((*frame->scan.bearings_rad)[i]) * 180 / M_PI, bearing_deg, 0.4) << i;
    ++readings;
  }
  EXPECT_EQ(readings, 254U) << "from 0 to 253 degrees";
}

/// The first scans of a real log. Readings that a laser without a return sends are 0.
class PlayedLog : public SensorSetTest {
 protected:
  void SetUp() override {
    const auto log = shared_file("mit-csail.clf.gz");
    if (!log) GTEST_SKIP() << kNeedsData;
    const auto frames = open_log(*log);
    for (std::size_t i = 0; i < 25; ++i) scans_.push_back(frames->next().value().scan.ranges_m);
    for (std::vector<float>& ranges_m : scans_)
      for (float& range_m : ranges_m)
        if (!(range_m > 0 && range_m < 16.0F)) range_m = 0;
  }

  template <class Emulator>
  std::vector<typename Emulator::Message> messages(std::size_t beams) const {
    std::vector<typename Emulator::Message> messages;
    for (const std::vector<float>& ranges_m : scans_)
      messages.push_back({{ranges_m.begin(), ranges_m.begin() + static_cast<std::ptrdiff_t>(beams)}, ""});
    return messages;
  }

  /// Expects scans of the log, up to the last one. `beams`: those whose readings the driver gives.
  void expect_scans(const std::string& text, std::size_t beams) {
    const auto add = [](std::vector<long>& readings_mm, float range_m) {
      if (range_m > 0) readings_mm.push_back(std::lround(range_m * 1000));
    };
    std::vector<std::vector<long>> played;
    for (const std::vector<float>& ranges_m : scans_) {
      played.emplace_back();
      for (std::size_t i = 0; i < beams; ++i) add(played.back(), ranges_m[i]);
    }
    SensorSet sensors(settings(text), control(), kIdle_s);
    std::size_t different = 0;
    for (std::vector<long> readings_mm; readings_mm != played.back(); ++different) {
      const auto object = sensors.next();
      const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(object.get());
      ASSERT_NE(scan, nullptr) << different << " scans came";
      readings_mm.clear();
      for (std::size_t i = 0; i < scan->getScanSize(); ++i)
        add(readings_mm, scan->getScanRangeValidity(i) ? scan->getScanRange(i) : 0);
      EXPECT_THAT(played, testing::Contains(readings_mm)) << "scan " << different;
    }
    EXPECT_GT(different, scans_.size() / 2);
    stop_ = true;
  }

  std::vector<std::vector<float>> scans_;
};

TEST_F(PlayedLog, by_a_hokuyo) {
  const HokuyoEmulator laser(port_, messages<HokuyoEmulator>(HokuyoEmulator::kBeams));
  expect_scans(hokuyo_settings(), HokuyoEmulator::kBeams);
}

TEST_F(PlayedLog, by_an_lms100) {
  const Lms100Emulator laser(messages<Lms100Emulator>(361));
  expect_scans(lms100_settings(laser.port()), 361);
}

TEST_F(PlayedLog, by_an_rplidar) {
  if (!RplidarEmulator::kDriverUnderstands) GTEST_SKIP() << RplidarEmulator::kNotUnderstood;
  const RplidarEmulator laser(port_, messages<RplidarEmulator>(RplidarEmulator::kBeams));
  expect_scans(rplidar_settings(), 254);
}

TEST_F(SensorSetTest, gives_frames_of_a_laser_and_odometry) {
  mrpt::hwdrivers::CGenericSensor::registerClass(SENSOR_CLASS_ID(SpinningWheels));
  LiveInput input;
  input.kind = LiveInput::Kind::kSensors;
  input.file = settings(hokuyo_settings() +
                        "[WHEELS]\ndriver = SpinningWheels\nprocess_rate = 200\n[global]\ndriver = no\n"
                        "[CAMERA]\ndriver = none\nrawlog-grabber-ignore = true\n")
                   .string();
  input.look_over_s = 0.2;
  input.idle_s = kIdle_s;
  std::vector<HokuyoEmulator::Message> messages;
  for (std::size_t i = 0; i < 500; ++i) messages.push_back({numbered_ranges(i), ""});
  const auto frames = open_live(input, {}, control());
  EXPECT_EQ(name_of(input), "sensors.ini");
  const HokuyoEmulator laser(port_, messages);
  TimeUs last_us = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    const auto frame = frames->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->scan.ranges_m.size(), HokuyoEmulator::kBeams);
    EXPECT_TRUE(std::isnan(frame->scan.ranges_m[1]));
    EXPECT_NEAR(frame->scan.robot_T_laser.x, 0.25, 1e-6);
    EXPECT_NEAR(frame->scan.robot_T_laser.phi, M_PI / 2, 1e-6);
    EXPECT_GT(frame->time_us, last_us);
    last_us = frame->time_us;
    if (i > 0) {
      EXPECT_TRUE(frame->has_odometry);
    }
  }
  stop_ = true;
}

TEST_F(SensorSetTest, drops_readings_of_imus_first_if_too_many_wait) {
  mrpt::hwdrivers::CGenericSensor::registerClass(SENSOR_CLASS_ID(Flood));
  SensorSet sensors(settings("[ALL]\ndriver = Flood\nprocess_rate = 100\nmax_queue_len = 100000\n"),
                    control(), kIdle_s);
  std::size_t taken = 0;
  std::size_t wheels = 0;
  while (taken < 10'000) {
    const auto object = sensors.next();
    ASSERT_TRUE(object) << taken;
    ++taken;
    if (dynamic_cast<const mrpt::obs::CObservationOdometry*>(object.get()) != nullptr) ++wheels;
  }
  EXPECT_EQ(wheels, 6000U);
  EXPECT_EQ(sensors.dropped().count, 2000U);
  EXPECT_THAT(sensors.dropped().first, HasSubstr("sensors.ini: more than 10,000 observations wait"));
  EXPECT_TRUE(soon([&] { return notices_.text().find("Lower process_rate") != std::string::npos; }));
  stop_ = true;
}

TEST_F(SensorSetTest, says_what_is_wrong_with_the_settings) {
  const auto complaint = [&](const std::string& text) {
    return sentence_of([&] { SensorSet(settings(text), control(), std::nullopt); });
  };
  EXPECT_THAT(complaint(""),
              HasSubstr("sensors.ini describes no sensor, expected a section with a key driver"));
  EXPECT_THAT(complaint("[A]\ndriver = CNoLaser\n"),
              HasSubstr("sensors.ini: section [A]: driver \"CNoLaser\" is unknown, expected a class"));
  EXPECT_THAT(complaint("[A]\ndriver = CHokuyoURG\nprocess_rate = 20\n"),
              AllOf(HasSubstr("section [A]: "), HasSubstr("Either COM_port or IP_DIR must be defined")));
  EXPECT_THAT(complaint("[A]\ndriver = CHokuyoURG\nCOM_port_LIN = ttyACM0\n"),
              HasSubstr("section [A]: process_rate is missing"));
  EXPECT_THAT(sentence_of([&] { SensorSet("none.ini", control(), std::nullopt); }),
              HasSubstr("none.ini does not exist"));
}

}  // namespace
}  // namespace psi_slam
