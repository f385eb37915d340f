// SPDX-License-Identifier: BSD-3-Clause
// Reads MRPT rawlogs, plain or compressed, in both common forms:
//
// - Actions and sensory frames. Odometry is the sum of the increments of the actions. Every scan of a sensory
//   frame has the odometry of that frame.
// - Single observations, in sensory frames or not. Absolute odometry comes in separate observations and is
//   interpolated at each scan's time.
//
// The kind of odometry that appears first is used; the other kind is ignored. A rawlog without odometry has
// scans only, or scans with the heading by a gyroscope (CObservationIMU). Scans are 2D range scans, or slices
// of the clouds of 3D sensors if `log.slice_z_m` is set. By default they come from the first laser in the
// log, and from other lasers at different poses, see UsualLasers. Time stamps, ticks of 100 ns since 1601,
// become Unix time rounded to the nearest microsecond.
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <set>
#include <utility>

#include "base/text_parts.h"
#include "logs/frames/gyroscope_choice.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_readings.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/look_over.h"
#include "logs/observations/cloud_points.h"
#include "logs/observations/mrpt_objects.h"
#include "logs/observations/observation_frames.h"
#include "logs/rawlog/observation_stream.h"
#include "logs/rawlog/rawlog_archive.h"
#include "logs/rawlog/rawlog_stream.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
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
  LogOptions options;  // with the chosen lasers
  std::vector<std::string> lasers;
  Odometry odometry;
  GyroscopeChoice gyroscope;
  std::vector<std::string> assumptions;  // about the lasers
};

/// Chooses lasers by the first scans of a log, for a user who selects none: the first laser, and all others
/// that are level, stay where they are mounted, and have a pose of their own or a mount that the user states.
class UsualLasers {
 public:
  explicit UsualLasers(const LogOptions& options) : options_(options) {}

  void add(const CObservation& scan) {
    const std::string& label = scan.sensorLabel;
    mrpt::poses::CPose3D robot_T_sensor;
    scan.getSensorPose(robot_T_sensor);
    const auto known =
        std::find_if(seen_.begin(), seen_.end(), [&](const Seen& laser) { return laser.label == label; });
    Seen& laser = known != seen_.end() ? *known : seen_.emplace_back(Seen{label, robot_T_sensor});
    laser.is_fixed = laser.is_fixed && robot_T_sensor == laser.robot_T_sensor &&
                     (is_cloud(scan) || is_level(robot_T_sensor));
    is_settled_ = is_settled_ || ++laser.scans == kEnoughScans;
  }

  /// Returns whether a laser that usually scans has appeared.
  bool is_settled() const { return is_settled_; }

  /// Labels of the chosen lasers, and of those that are left out.
  std::pair<std::vector<std::string>, std::vector<std::string>> choose() const {
    std::vector<const Seen*> chosen;
    std::vector<std::string> left_out;
    for (const Seen& laser : seen_) {
      const bool can_join =
          can_be_combined(laser) && std::all_of(chosen.begin(), chosen.end(), [&](auto* other) {
            return can_be_combined(*other) && are_apart(laser, *other);
          });
      if (chosen.empty() || can_join)
        chosen.push_back(&laser);
      else
        left_out.push_back(laser.label);
    }
    std::vector<std::string> labels;
    for (const Seen* laser : chosen) labels.push_back(laser->label);
    return {labels, left_out};
  }

 private:
  static constexpr std::size_t kEnoughScans = 200;

  struct Seen {
    std::string label;
    mrpt::poses::CPose3D robot_T_sensor;  // in the first scan
    bool is_fixed = true;
    std::size_t scans = 0;
  };

  static bool is_level(const mrpt::poses::CPose3D& robot_T_sensor) {
    try {
      floor_mount(robot_T_sensor, "");
      return true;
    } catch (const UserError&) {
      return false;
    }
  }

  /// Returns whether log.laser can name the laser in a list, and the laser stays where it is mounted.
  static bool can_be_combined(const Seen& laser) { return can_be_listed(laser.label) && laser.is_fixed; }

  bool is_stated(const Seen& laser) const {
    return options_of_laser(options_, {laser.label}).robot_T_laser.has_value();
  }

  bool are_apart(const Seen& a, const Seen& b) const {
    return is_stated(a) || is_stated(b) || !(a.robot_T_sensor == b.robot_T_sensor);
  }

  LogOptions options_;
  std::vector<Seen> seen_;
  bool is_settled_ = false;
};

/// Labels of lasers that the user states, each with the name of the option that states it.
std::vector<std::pair<std::string, std::string>> named_labels(const LogOptions& options) {
  std::vector<std::pair<std::string, std::string>> named;
  for (const std::string& label : laser_choice("log.laser", options.laser).names)
    named.emplace_back(label, "log.laser");
  for (const auto& [option, label] : lasers_with_stated_values(options)) named.emplace_back(label, option);
  return named;
}

/// Combines the usual lasers of a log, if there are several.
void use(const UsualLasers& usual, Sensors& sensors) {
  const auto [chosen, left_out] = usual.choose();
  if (const std::string choice = choice_of_lasers(chosen, left_out); !choice.empty())
    sensors.assumptions.push_back(choice);
  if (chosen.size() < 2) return;
  sensors.lasers = chosen;
  sensors.options.laser.clear();
  for (const std::string& label : chosen)
    sensors.options.laser += (sensors.options.laser.empty() ? "" : ",") + label;
}

/// Finds the lasers to read, the kind of odometry and the gyroscope. Reads objects until the lasers, all
/// sensors that the user names, and odometry have appeared, or to their end. Throws UserError if a sensor is
/// missing; lasers of a stream may appear later, except for one of those that log.laser names.
Sensors find_sensors(ObjectSource& archive, const LogOptions& options, bool of_stream = false) {
  const std::filesystem::path& path = archive.path();
  const auto named = named_labels(options);
  const LaserChoice choice = laser_choice("log.laser", options.laser);
  ChosenLasers chosen(choice);
  const bool selects_lasers = choice.all || !choice.names.empty() || options.robot_T_laser;
  UsualLasers usual(options);
  auto odometry = ignores_odometry(options) ? Odometry::kNone : Odometry::kUndecided;
  const bool slices = height_slice(options).has_value();
  bool has_clouds = false;
  std::set<std::string> labels;
  std::set<std::string> gyroscopes;
  const auto is_missing = [&](const auto& name) { return labels.count(name.first) == 0; };
  const auto needs_gyroscopes = [&] {
    if (names_gyroscope(options)) return gyroscopes.count(options.imu) == 0;
    return odometry == Odometry::kNone && !ignores_gyroscope(options);
  };
  const auto lacks_sensors = [&] {
    return odometry == Odometry::kUndecided || labels.empty() || needs_gyroscopes() ||
           std::any_of(named.begin(), named.end(), is_missing);
  };
  while (lacks_sensors() || ((choice.all || !selects_lasers) && !usual.is_settled())) {
    mrpt::serialization::CSerializable::Ptr object;
    try {
      object = archive.next();
    } catch (const UserError&) {  // damage is reported where the log is read
      if (lacks_sensors()) throw;
    }
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
      has_clouds = has_clouds || is_cloud(observation);
      if (!is_scan(observation, slices)) return;
      labels.insert(observation.sensorLabel);
      chosen.number_of(observation.sensorLabel);
      usual.add(observation);
    });
  }
  if (labels.empty()) {
    const std::string expected = slices ? " has no point clouds, expected observations of a 3D sensor"
                                        : " has no laser scans, expected observations of class "
                                          "CObservation2DRangeScan";
    const bool are_sliceable = !slices && has_clouds;
    throw UserError(path.string() + expected +
                    (slices          ? ". Map laser scans with an empty log.slice_z_m"
                     : are_sliceable ? ". Map a slice of its point clouds with log.slice_z_m, such as "
                                       "\"0.1 1.0\" (heights above the floor in metres)"
                                     : ". Choose another log"));
  }
  const bool selected_is_found = std::any_of(choice.names.begin(), choice.names.end(),
                                             [&](const auto& name) { return labels.count(name) != 0; });
  const bool may_come_later = of_stream && (choice.names.empty() || selected_is_found);
  std::vector<std::string> assumptions;
  for (const auto& [label, option] : named)
    if (may_come_later && labels.count(label) == 0) assumptions.push_back(late_laser_text(option, label));
  const auto missing = may_come_later ? named.end() : std::find_if(named.begin(), named.end(), is_missing);
  if (missing != named.end()) {
    throw UserError(missing->second + " is \"" + missing->first + "\", expected the label of a laser of " +
                    path.string() + ": " + quoted_list({labels.begin(), labels.end()}));
  }
  if (odometry == Odometry::kUndecided) odometry = Odometry::kNone;
  Sensors found{options, chosen.names(), odometry,
                choose_gyroscope(options, {gyroscopes.begin(), gyroscopes.end()}, odometry != Odometry::kNone,
                                 "the label of a CObservationIMU with a rate of turn of " + path.string()),
                assumptions};
  if (!selects_lasers) use(usual, found);
  return found;
}

Sensors find_sensors(const std::filesystem::path& path, const LogOptions& options) {
  RawlogArchive archive(path, height_slice(options).has_value());
  return find_sensors(archive, options);
}

// Objects that are kept while a stream is looked over. Scans that are looked over are kept in any case.
constexpr std::size_t kMostObjectsOfHead = 10'000;

/// Objects in memory, and after them those of another source unless that is null.
class KeptObjects : public ObjectSource {
 public:
  KeptObjects(std::vector<mrpt::serialization::CSerializable::Ptr> objects, std::filesystem::path path,
              std::unique_ptr<ObjectSource> rest = nullptr)
      : objects_(std::move(objects)), path_(std::move(path)), rest_(std::move(rest)) {}

  mrpt::serialization::CSerializable::Ptr next() override {
    if (next_ == objects_.size()) return rest_ ? rest_->next() : nullptr;
    return std::move(objects_[next_++]);  // objects that were read need no memory
  }
  std::string place() const override {
    if (next_ == objects_.size() && rest_) return rest_->place();
    return path_.string() + ": object " + std::to_string(next_);
  }
  SkippedLines dropped() const override { return rest_ ? rest_->dropped() : SkippedLines(); }
  const std::filesystem::path& path() const override { return path_; }
  double progress() const override { return 0; }

 private:
  std::vector<mrpt::serialization::CSerializable::Ptr> objects_;
  std::filesystem::path path_;
  std::unique_ptr<ObjectSource> rest_;
  std::size_t next_ = 0;
};

/// What psi-slam uses of the objects of a rawlog that is being recorded. Images would take much memory.
class UsedObjects : public ObjectSource {
 public:
  UsedObjects(std::unique_ptr<ByteSource> recording, bool slices)
      : stream_(std::move(recording), true), slices_(slices) {
    find_external_files(stream_.path());
  }

  mrpt::serialization::CSerializable::Ptr next() override {
    while (const auto object = stream_.next())
      if (auto used = used_part(object, slices_)) return used;
    return nullptr;
  }
  std::string place() const override { return stream_.place(); }
  SkippedLines dropped() const override { return stream_.dropped(); }
  const std::filesystem::path& path() const override { return stream_.path(); }
  double progress() const override { return stream_.progress(); }

 private:
  RawlogStream stream_;
  bool slices_;
};

/// Returns the scans of an object that have a time stamp.
std::vector<const CObservation*> scans_of(mrpt::serialization::CSerializable& object, bool slices) {
  std::vector<const CObservation*> scans;
  for_each_observation(object, [&](const CObservation& observation) {
    if (is_scan(observation, slices) && time_us(observation)) scans.push_back(&observation);
  });
  return scans;
}

/// Reads a stream until it has been looked over, see LookOver. Keeps the latest objects besides the scans.
std::vector<mrpt::serialization::CSerializable::Ptr> look_over(ObjectSource& stream,
                                                               const LogOptions& options,
                                                               double look_over_s) {
  std::deque<mrpt::serialization::CSerializable::Ptr> head;
  std::set<std::string> awaited;
  for (const auto& [label, option] : named_labels(options)) awaited.insert(label);
  LookOver scans(look_over_s);
  const bool slices = height_slice(options).has_value();
  while (!scans.is_enough(!awaited.empty())) {
    head.push_back(stream.next());
    if (!head.back()) {
      head.pop_back();
      break;
    }
    const auto scans_of_object = scans_of(*head.back(), slices);
    for (const CObservation* scan : scans_of_object) {
      scans.add_scan(*time_us(*scan));
      awaited.erase(scan->sensorLabel);
    }
    if (scans_of_object.empty() && head.size() > kMostObjectsOfHead)
      head.erase(std::find_if(head.begin(), head.end(),
                              [&](const auto& object) { return scans_of(*object, slices).empty(); }));
  }
  return {head.begin(), head.end()};
}

class RawlogReader : public LogReader {
 public:
  RawlogReader(const std::filesystem::path& path, const LogOptions& options)
      : RawlogReader(std::make_unique<RawlogArchive>(path, height_slice(options).has_value()),
                     find_sensors(path, options)) {}

  /// Reads objects from their beginning. With `of_stream`, skips scans whose mount the user has to state.
  RawlogReader(std::unique_ptr<ObjectSource> objects, Sensors found, bool of_stream = false)
      : archive_(std::move(objects)),
        found_(std::move(found)),
        frames_(found_.options, found_.odometry, found_.gyroscope.name,
                of_stream ? kMostWaitingOfStream : OdometryInterpolator::kMaxWaiting),
        is_stream_(of_stream),
        slices_clouds_(height_slice(found_.options).has_value()) {
    contents_.laser = name_list(found_.lasers);
    contents_.several_lasers = found_.lasers.size() > 1;
    name_lasers(found_.lasers);
    contents_.assumptions = found_.assumptions;
    if (!found_.gyroscope.assumption.empty()) contents_.assumptions.push_back(found_.gyroscope.assumption);
  }

  double progress() const override { return archive_->progress(); }

 protected:
  std::optional<Frame> read_frame() override {
    while (true) {
      if (auto frame = frames_.next()) return frame;
      if (at_end_ && frames_read() == 0 && frames_.scans() > 0 && contents_.skipped.count > 0)
        throw UserError(contents_.skipped.first +
                        ", as in all of its observations. Map without odometry with log.odometry=none");
      if (at_end_ && frames_read() == 0 && invalid_.count > 0) throw UserError(invalid_.first);
      if (at_end_) return std::nullopt;
      if (const auto object = archive_->next()) {
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
      frames_.take(*actions, archive_->place());
    for_each_observation(object, [&](const CObservation& observation) { take_or_skip(observation); });
    contents_.skipped = frames_.skipped() + invalid_ + archive_->dropped();
  }

  void take_or_skip(const CObservation& observation) {
    try {
      take(observation);
    } catch (const UserError& error) {
      if (!is_stream_ && dynamic_cast<const MissingMount*>(&error) != nullptr) throw;
      if (invalid_.count++ == 0) invalid_.first = error.what();
    }
  }

  void take(const CObservation& observation) {
    const std::size_t scans = frames_.scans();
    frames_.take(observation, archive_->place());
    const bool is_unused = is_scan(observation, slices_clouds_) && frames_.scans() == scans;
    if (is_unused) ++contents_.other_lasers[observation.sensorLabel];
    if (const auto labels = frames_.labels(); labels.size() > contents_.laser_names.size())
      name_lasers(labels);
  }

  void name_lasers(const std::vector<std::string>& labels) {
    contents_.laser_names.clear();
    for (const std::string& label : labels) contents_.laser_names.push_back({label});
  }

  std::unique_ptr<ObjectSource> archive_;
  Sensors found_;
  ObservationFrames frames_;
  bool is_stream_;
  bool slices_clouds_;
  SkippedLines invalid_;  // observations besides odometry with an invalid pose
  bool at_end_ = false;
};

}  // namespace

std::unique_ptr<LogReader> open_rawlog(const std::filesystem::path& path, const LogOptions& options) {
  return std::make_unique<RawlogReader>(path, options);
}

std::unique_ptr<LogReader> open_rawlog_stream(std::unique_ptr<ByteSource> recording,
                                              const LogOptions& options, double look_over_s) {
  const bool slices = height_slice(options).has_value();
  return open_observation_stream(std::make_unique<UsedObjects>(std::move(recording), slices), options,
                                 look_over_s);
}

std::unique_ptr<LogReader> open_observation_stream(std::unique_ptr<ObjectSource> stream,
                                                   const LogOptions& options, double look_over_s) {
  const auto head = look_over(*stream, options, look_over_s);
  const std::filesystem::path path = stream->path();
  KeptObjects first(head, path);
  return std::make_unique<RawlogReader>(std::make_unique<KeptObjects>(head, path, std::move(stream)),
                                        find_sensors(first, options, true), true);
}

}  // namespace psi_slam
