// SPDX-License-Identifier: BSD-3-Clause
// Sensors that drivers of MRPT read.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "live/live_control.h"
#include "logs/rawlog/object_source.h"

namespace psi_slam {

/// Reads the sensors of a settings file as rawlog-grabber and icp-slam-live do: each section with a key
/// `driver` is a sensor, whose driver is a class of mrpt::hwdrivers, and is read in a thread of its own.
/// Yields scans, odometry, robot actions and readings of IMUs in the order of their arrival; other
/// observations are dropped. At most 10,000 objects wait to be taken. If more come, drops the oldest readings
/// of IMUs, or else the oldest objects; dropped() counts them, and a notice reports the first.
///
/// Restarts a driver every second, with a notice, if it fails or sends empty scans, or if a laser sends
/// nothing for five seconds.
class SensorSet : public ObjectSource {
 public:
  /// Loads the settings of all sensors. next() starts them. `idle_s`: see LiveInput. Throws UserError if the
  /// file is unreadable, names no sensor or an unknown driver, or if a driver rejects its settings.
  SensorSet(std::filesystem::path settings, LiveControl control, std::optional<double> idle_s);
  /// Waits until all drivers have returned.
  ~SensorSet() override;
  SensorSet(const SensorSet&) = delete;
  SensorSet& operator=(const SensorSet&) = delete;

  mrpt::serialization::CSerializable::Ptr next() override;
  std::string place() const override;
  SkippedLines dropped() const override;
  const std::filesystem::path& path() const override { return settings_; }
  double progress() const override { return 0; }

 private:
  class Sensor;

  void start();
  void keep_reading(const std::string& section);
  void read(const std::string& section, bool& works);
  void keep(const std::vector<mrpt::serialization::CSerializable::Ptr>& objects);
  void pause(std::chrono::duration<double> time);
  bool should_stop() const;

  std::filesystem::path settings_;
  LiveControl control_;
  std::optional<double> idle_s_;
  std::vector<std::string> sections_;
  std::vector<std::thread> threads_;
  std::size_t given_ = 0;

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::deque<mrpt::serialization::CSerializable::Ptr> objects_;
  std::size_t dropped_ = 0;
  bool ended_ = false;
};

}  // namespace psi_slam
