// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_set.h"

#include <gmock/gmock.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

#include "hokuyo_emulator.h"
#include "live/live_source.h"
#include "lms100_emulator.h"
#include "sender.h"
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
