// SPDX-License-Identifier: BSD-3-Clause
// Reads MRPT rawlogs, plain or gzipped, in both common forms:
//
// - Actions and sensory frames. Odometry is the sum of the increments of the actions. Every scan of a sensory
//   frame has the odometry of that frame.
// - Single observations, in sensory frames or not. Absolute odometry comes in separate observations and is
//   interpolated at each scan's time.
//
// The kind of odometry that appears first is used; the other kind is ignored. A rawlog without odometry has
// scans only, or scans with the heading by a gyroscope (CObservationIMU). By default scans come from the
// first laser in the log. Time stamps, ticks of 100 ns since 1601, become Unix time rounded to the nearest
// microsecond.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <functional>
#include <set>

#include "base/text_parts.h"
#include "frames/gyroscope_choice.h"
#include "frames/log_reader.h"
#include "observations/mrpt_objects.h"
#include "observations/observation_frames.h"
#include "psi_slam/user_error.h"
#include "rawlog/rawlog_archive.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::obs::CObservationIMU;
using mrpt::obs::CObservationOdometry;
using mrpt::obs::CSensoryFrame;
using Odometry = ObservationFrames::Odometry;

void for_each_observation(mrpt::serialization::CSerializable& object,
                          const std::function<void(const CObservation&)>& take) {
  if (const auto* observation = dynamic_cast<const CObservation*>(&object)) take(*observation);
  if (const auto* frame = dynamic_cast<const CSensoryFrame*>(&object))
    for (const auto& observation : *frame) take(*observation);
}

struct Sensors {
  std::string lasers;  // labels of the lasers to read, separated by commas
  Odometry odometry;
  GyroscopeChoice gyroscope;
};

/// Labels of lasers that the user states, each with the name of the option that states it.
std::vector<std::pair<std::string, std::string>> named_labels(const LogOptions& options) {
  std::vector<std::pair<std::string, std::string>> named;
  for (const std::string& label : laser_choice("log.laser", options.laser).names)
    named.emplace_back(label, "log.laser");
  for (const StatedMount& mount : stated_mounts(options)) named.emplace_back(mount.name, "log.laser_mounts");
  return named;
}

/// Finds the lasers to read, the kind of odometry and the gyroscope. Reads the rawlog until a laser, all
/// sensors that the user names, and odometry have appeared, or to its end. Throws UserError if a sensor is
/// missing.
Sensors find_sensors(const std::filesystem::path& path, const LogOptions& options) {
  RawlogArchive archive(path);
  const auto named = named_labels(options);
  ChosenLasers chosen(laser_choice("log.laser", options.laser));
  auto odometry = ignores_odometry(options) ? Odometry::kNone : Odometry::kUndecided;
  std::set<std::string> labels;
  std::set<std::string> gyroscopes;
  const auto is_missing = [&](const auto& name) { return labels.count(name.first) == 0; };
  const auto needs_gyroscopes = [&] {
    if (names_gyroscope(options)) return gyroscopes.count(options.imu) == 0;
    return odometry == Odometry::kNone && !ignores_gyroscope(options);
  };
  while (odometry == Odometry::kUndecided || labels.empty() || needs_gyroscopes() ||
         std::any_of(named.begin(), named.end(), is_missing)) {
    const auto object = archive.next();
    if (!object) break;
    const auto* actions = dynamic_cast<const CActionCollection*>(object.get());
    if (odometry == Odometry::kUndecided && actions != nullptr && movement_of(*actions))
      odometry = Odometry::kActions;
    for_each_observation(*object, [&](const CObservation& observation) {
      if (odometry == Odometry::kUndecided &&
          dynamic_cast<const CObservationOdometry*>(&observation) != nullptr)
        odometry = Odometry::kObservations;
      const auto* imu = dynamic_cast<const CObservationIMU*>(&observation);
      if (imu != nullptr && has_rate(*imu)) gyroscopes.insert(imu->sensorLabel);
      if (dynamic_cast<const CObservation2DRangeScan*>(&observation) == nullptr) return;
      labels.insert(observation.sensorLabel);
      chosen.number_of(observation.sensorLabel);
    });
  }
  if (labels.empty()) {
    throw UserError(
        path.string() +
        " has no laser scans, expected observations of class CObservation2DRangeScan. Choose another log");
  }
  if (const auto missing = std::find_if(named.begin(), named.end(), is_missing); missing != named.end()) {
    throw UserError(missing->second + " is \"" + missing->first + "\", expected the label of a laser of " +
                    path.string() + ": " + quoted_list({labels.begin(), labels.end()}));
  }
  if (odometry == Odometry::kUndecided) odometry = Odometry::kNone;
  return {name_list(chosen.names()), odometry,
          choose_gyroscope(options, {gyroscopes.begin(), gyroscopes.end()}, odometry != Odometry::kNone,
                           "the label of a CObservationIMU with a rate of turn of " + path.string())};
}

class RawlogReader : public LogReader {
 public:
  RawlogReader(const std::filesystem::path& path, const LogOptions& options)
      : archive_(path),
        found_(find_sensors(path, options)),
        frames_(options, found_.odometry, found_.gyroscope.name) {
    contents_.laser = found_.lasers;
    if (!found_.gyroscope.assumption.empty()) contents_.assumptions.push_back(found_.gyroscope.assumption);
  }

  double progress() const override { return archive_.progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    while (true) {
      if (auto frame = frames_.next()) return frame;
      if (at_end_) return std::nullopt;
      if (const auto object = archive_.next()) {
        take(*object);
      } else {
        at_end_ = true;
        frames_.end_of_log();
      }
    }
  }

 private:
  void take(mrpt::serialization::CSerializable& object) {
    if (const auto* actions = dynamic_cast<const CActionCollection*>(&object))
      frames_.take(*actions, archive_.place());
    for_each_observation(object, [&](const CObservation& observation) {
      const std::size_t scans = frames_.scans();
      frames_.take(observation, archive_.place());
      const bool is_scan = dynamic_cast<const CObservation2DRangeScan*>(&observation) != nullptr;
      if (is_scan && frames_.scans() == scans) ++contents_.other_lasers[observation.sensorLabel];
    });
    contents_.skipped = frames_.skipped();
  }

  RawlogArchive archive_;
  Sensors found_;
  ObservationFrames frames_;
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_rawlog(const std::filesystem::path& path, const LogOptions& options) {
  return std::make_unique<RawlogReader>(path, options);
}

}  // namespace psi_slam
