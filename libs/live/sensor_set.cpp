// SPDX-License-Identifier: BSD-3-Clause
#include "live/sensor_set.h"

#include <signal.h>

#include <mrpt/config/CConfigFile.h>
#include <mrpt/core/exceptions.h>
#include <mrpt/hwdrivers/C2DRangeFinderAbstract.h>
#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/hwdrivers/CRoboPeakLidar.h>
#include <mrpt/hwdrivers/registerAllClasses.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/system/COutputLogger.h>
#include <mrpt/version.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/degrees.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::hwdrivers::CGenericSensor;
using mrpt::serialization::CSerializable;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kWait = 100ms;  // next() looks at the user's wishes so often
constexpr auto kFailing = 1s;  // errors of a driver that last longer restart it
constexpr auto kSilent = 5s;   // so does a laser without scans
constexpr auto kBeforeRestart = 1s;
constexpr std::size_t kMostWaiting = 10'000;  // objects that wait
constexpr const char* kTooSlow = "more than 10,000 observations wait, so the oldest are dropped";

/// First line of the message of a driver, without the place in its source code.
std::string reason_of(const std::exception& error) {
  const auto* with_stack = dynamic_cast<const mrpt::ExceptionWithCallBackBase*>(&error);
  const std::string text = with_stack != nullptr ? with_stack->originalWhat : error.what();
  const std::string line(trimmed(std::string_view(text).substr(0, text.find('\n')), " \t\r:."));
  return line.empty() ? "unknown error" : line;
}

bool is_wanted(const CSerializable& object) {
  return dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationOdometry*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CActionCollection*>(&object) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationIMU*>(&object) != nullptr;
}

bool is_imu(const CSerializable::Ptr& object) {
  return dynamic_cast<const mrpt::obs::CObservationIMU*>(object.get()) != nullptr;
}

/// Some drivers make a scan without readings of a broken connection.
bool is_empty_scan(const CSerializable& object) {
  const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&object);
  return scan != nullptr && scan->getScanSize() == 0;
}

// The drivers of MRPT 2.15.0 (0x20f00) and later were not tested.
constexpr bool kCorrectsRplidar = MRPT_VERSION < 0x20f00;

/// Corrects a scan of CRoboPeakLidar. This driver (MRPT 2.5.8 to 2.14) takes the angles of the laser, in
/// units of 90/16384 degrees, for units of 1/128 degree. So reading k is of k * 45/64 degrees, not of k
/// degrees, and the readings beyond 253 degrees are lost.
void correct_rplidar(mrpt::obs::CObservation2DRangeScan& scan) {
  constexpr std::size_t kReadings = 512;  // in a turn, of which the driver keeps the first
  const std::size_t kept = scan.getScanSize();
  scan.resizeScan(kReadings);
  for (std::size_t i = kept; i < kReadings; ++i) {
    scan.setScanRange(i, 0);
    scan.setScanRangeValidity(i, false);
  }
  scan.aperture = static_cast<float>((kReadings - 1) * radians_from_degrees(45.0L / 64));
}

/// Makes the driver of a section and loads its settings. Throws std::exception for invalid settings.
CGenericSensor::Ptr make_driver(const mrpt::config::CConfigFile& settings, const std::string& section) {
  const std::string name = settings.read_string(section, "driver", "");
  auto driver = CGenericSensor::createSensorPtr(name);
  if (!driver)
    throw std::runtime_error("driver \"" + name +
                             "\" is unknown, expected a class of mrpt::hwdrivers such as CHokuyoURG");
  if (auto* logger = dynamic_cast<mrpt::system::COutputLogger*>(driver.get()))
    logger->logging_enable_console_output = false;  // standard output is for poses
  driver->loadConfig(settings, section);
  if (!(driver->getProcessRate() > 0))
    throw std::runtime_error("process_rate is missing, expected the readings per second, such as 20");
  return driver;
}

}  // namespace

/// A driver that is running.
class SensorSet::Sensor {
 public:
  Sensor(const std::filesystem::path& settings, const std::string& section)
      : driver_(make_driver(mrpt::config::CConfigFile(settings.string()), section)),
        is_laser_(dynamic_cast<const mrpt::hwdrivers::C2DRangeFinderAbstract*>(driver_.get()) != nullptr),
        is_rplidar_(dynamic_cast<const mrpt::hwdrivers::CRoboPeakLidar*>(driver_.get()) != nullptr) {
    driver_->initialize();
    last_object_ = Clock::now();  // some drivers take long to start
  }

  std::chrono::duration<double> period() const {
    return std::chrono::duration<double>(1 / driver_->getProcessRate());
  }

  /// A remark for users on what the driver gives.
  const char* remark() const {
    if (!is_rplidar_) return "";
    return kCorrectsRplidar
               ? ", but the driver loses the readings from 73 to 180 degrees to the right"
               : ". Check the map: psi-slam corrects this driver's bearings up to MRPT 2.14 only";
  }

  /// Reads the sensor once. Throws std::exception if it has failed for some time.
  std::vector<CSerializable::Ptr> read() {
    driver_->doProcess();
    std::vector<CSerializable::Ptr> objects;
    const CGenericSensor::TListObservations observations = driver_->getObservations();
    bool fails = driver_->getState() == CGenericSensor::ssError;
    for (const auto& [stamp, object] : observations) {
      fails = fails || is_empty_scan(*object);
      if (!is_wanted(*object) || is_empty_scan(*object)) continue;
      if (is_rplidar_ && kCorrectsRplidar)
        correct_rplidar(dynamic_cast<mrpt::obs::CObservation2DRangeScan&>(*object));
      objects.push_back(object);
    }
    watch(!objects.empty(), fails);
    return objects;
  }

 private:
  void watch(bool works, bool fails) {
    const Clock::time_point now = Clock::now();
    if (works) last_object_ = now;
    if (works || !fails) failing_since_.reset();
    if (fails && !failing_since_) failing_since_ = now;
    if (failing_since_ && now - *failing_since_ > kFailing)
      throw std::runtime_error("the driver reports errors");
    if (is_laser_ && now - last_object_ > kSilent) throw std::runtime_error("no scan came for 5 s");
  }

  CGenericSensor::Ptr driver_;
  bool is_laser_;
  bool is_rplidar_;
  Clock::time_point last_object_;
  std::optional<Clock::time_point> failing_since_;
};

SensorSet::SensorSet(std::filesystem::path settings, LiveControl control, std::optional<double> idle_s)
    : settings_(std::move(settings)), control_(std::move(control)), idle_s_(idle_s) {
  mrpt::hwdrivers::registerAllClasses_mrpt_hwdrivers();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(settings_, ignored))
    throw UserError(settings_.string() +
                    " does not exist, expected a settings file of rawlog-grabber. Check the path");
  const mrpt::config::CConfigFile file(settings_.string());
  std::vector<std::string> all;
  file.getAllSections(all);
  for (const std::string& section : all) {
    if (section == "global" || !file.keyExists(section, "driver") ||
        file.read_bool(section, "rawlog-grabber-ignore", false))
      continue;
    try {
      make_driver(file, section);
    } catch (const std::exception& error) {
      throw UserError(settings_.string() + ": section [" + section + "]: " + reason_of(error));
    }
    sections_.push_back(section);
  }
  if (sections_.empty())
    throw UserError(settings_.string() +
                    " describes no sensor, expected a section with a key driver such as driver = CHokuyoURG");
}

SensorSet::~SensorSet() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool SensorSet::should_stop() const {
  if (control_.should_stop()) return true;
  const std::lock_guard lock(mutex_);
  return ended_;
}

/// Waits, but not beyond the end.
void SensorSet::pause(std::chrono::duration<double> time) {
  const auto end = Clock::now() + time;
  while (!should_stop() && Clock::now() < end) {
    std::unique_lock lock(mutex_);
    const std::chrono::duration<double> left = end - Clock::now();
    changed_.wait_for(lock, std::min<std::chrono::duration<double>>(left, kWait), [this] { return ended_; });
  }
}

void SensorSet::start() {
  for (const std::string& section : sections_)
    threads_.emplace_back([this, section] { keep_reading(section); });
}

/// Reads a sensor again and again, also after failures. Runs in a thread of its own.
void SensorSet::keep_reading(const std::string& section) {
  // A driver that writes to a closed connection must not end the program.
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
  std::string last_reason;
  while (!should_stop()) {
    bool works = false;
    try {
      read(section, works);
    } catch (const std::exception& error) {
      const std::string reason = reason_of(error);
      if (works || reason != last_reason)
        control_.notify("sensor [" + section + "] failed: " + reason + ". It is started again every second");
      last_reason = reason;
    }
    pause(kBeforeRestart);
  }
}

/// Starts a sensor and reads it until the end. Sets `works` at its first data. Throws std::exception if the
/// sensor fails.
void SensorSet::read(const std::string& section, bool& works) {
  Sensor sensor(settings_, section);
  while (!should_stop()) {
    const Clock::time_point began = Clock::now();
    const auto objects = sensor.read();
    if (!objects.empty() && !std::exchange(works, true))
      control_.notify("sensor [" + section + "] sends data" + sensor.remark());
    keep(objects);
    pause(began + sensor.period() - Clock::now());
  }
}

/// Lets objects wait for next().
void SensorSet::keep(const std::vector<CSerializable::Ptr>& objects) {
  bool is_first = false;
  {
    const std::lock_guard lock(mutex_);
    objects_.insert(objects_.end(), objects.begin(), objects.end());
    is_first = dropped_ == 0 && objects_.size() > kMostWaiting;
    for (; objects_.size() > kMostWaiting; ++dropped_) {
      const auto imu = std::find_if(objects_.begin(), objects_.end(), is_imu);
      objects_.erase(imu != objects_.end() ? imu : objects_.begin());
    }
  }
  changed_.notify_all();
  if (is_first)
    control_.notify(std::string(kTooSlow) + ". Lower process_rate, or choose settings that map faster");
}

SkippedLines SensorSet::dropped() const {
  const std::lock_guard lock(mutex_);
  if (dropped_ == 0) return {};
  return {dropped_, settings_.string() + ": " + kTooSlow, 0};
}

CSerializable::Ptr SensorSet::next() {
  if (threads_.empty()) start();
  const Clock::time_point began = Clock::now();
  while (true) {
    const bool is_over = control_.should_stop() ||
                         (idle_s_ && std::chrono::duration<double>(Clock::now() - began).count() >= *idle_s_);
    std::unique_lock lock(mutex_);
    if (objects_.empty() && !is_over) changed_.wait_for(lock, kWait, [this] { return !objects_.empty(); });
    if (objects_.empty() && !is_over) continue;
    if (objects_.empty()) return nullptr;
    CSerializable::Ptr object = std::move(objects_.front());
    objects_.pop_front();
    ++given_;
    return object;
  }
}

std::string SensorSet::place() const {
  return settings_.string() + ": observation " + std::to_string(given_);
}

}  // namespace psi_slam
