// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/own_body.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/look_over.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_neighbours.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kCell_m = 0.01;
constexpr std::size_t kCells = 200;       // ranges below 2 m, twice the reach
constexpr std::size_t kReachCells = 100;  // ranges below kReach_m
constexpr std::size_t kLeastFarCells = 30;
constexpr double kMaskedTolerances = 2;  // the mask includes readings that scatter more than usual
constexpr std::size_t kLeastFarReadings = 20;
constexpr std::size_t kMostSectorsInText = 5;
static_assert(OwnBodyFinder::kMostKeyScans <= std::numeric_limits<std::uint8_t>::max());

/// Largest difference between a reading of the body and its range.
double tolerance_m(double range_m) {
  return 0.03 + 0.01 * range_m;
}

/// Ranges by bin; NaN for bins without a reading. The nearest of several readings in a bin counts.
std::vector<float> ranges_by_bin(const LaserScan& scan, const BearingBins& bins) {
  std::vector<float> ranges_m(bins.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const float range_m = scan.ranges_m[i];
    const auto bin = bins.bin_of((*scan.bearings_rad)[i]);
    if (!bin || std::isnan(range_m)) continue;
    float& in_bin_m = ranges_m[*bin];
    if (!(in_bin_m <= range_m)) in_bin_m = range_m;
  }
  return ranges_m;
}

/// Returns whether at least `least_share` of the far readings differ between two scans.
bool scene_changed(const std::vector<float>& before_m, const std::vector<float>& now_m, double least_share) {
  std::size_t far = 0;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < now_m.size(); ++i) {
    const auto a = static_cast<double>(before_m[i]);
    const auto b = static_cast<double>(now_m[i]);
    const bool tells = !std::isnan(a) && !std::isnan(b) && std::max(a, b) >= OwnBodyFinder::kFar_m &&
                       (std::isfinite(a) || std::isfinite(b));
    if (!tells) continue;
    ++far;
    if (std::abs(a - b) > 0.1 + 0.1 * std::min(a, b)) ++changed;
  }
  return far >= kLeastFarReadings && static_cast<double>(changed) >= least_share * static_cast<double>(far);
}

/// Range of the body along a beam, metres; 0 if the beam does not see it. `counts` are the beam's readings in
/// all key scans by range, kCells of them.
double body_range_m(const std::uint8_t* counts, std::size_t least_seen) {
  std::array<std::size_t, kCells + 1> below{};  // readings in the cells before each cell
  for (std::size_t cell = 0; cell < kCells; ++cell) below[cell + 1] = below[cell] + counts[cell];
  std::size_t most_seen = 0;
  double range_m = 0;
  for (std::size_t cell = 0; cell < kReachCells; ++cell) {
    const double centre_m = (static_cast<double>(cell) + 0.5) * kCell_m;
    const auto reach = static_cast<std::size_t>(std::lround(tolerance_m(centre_m) / kCell_m));
    const std::size_t from = cell < reach ? 0 : cell - reach;
    const std::size_t to = cell + reach + 1;
    const std::size_t seen = below[to] - below[from];
    const std::size_t near = below[std::max(2 * cell, cell + kLeastFarCells)];
    const bool is_body = seen >= least_seen &&
                         static_cast<double>(seen) >= OwnBodyFinder::kLeastShare * static_cast<double>(near);
    if (!is_body || seen <= most_seen) continue;
    most_seen = seen;
    double sum_m = 0;
    for (std::size_t i = from; i < to; ++i) sum_m += counts[i] * (static_cast<double>(i) + 0.5) * kCell_m;
    range_m = sum_m / static_cast<double>(seen);
  }
  return range_m;
}

std::string degrees_text(double radians) {
  return fixed_text(mrpt::RAD2DEG(radians) + 0.0, 1);  // adding 0.0 turns -0 into 0
}

std::string text_of(const BodySector& sector) {
  std::string text = counted(sector.beams, "beam");
  if (sector.beams == 1)
    text += " at " + degrees_text(sector.from_rad);
  else
    text += " from " + degrees_text(sector.from_rad) + " to " + degrees_text(sector.to_rad);
  text += " degrees at " + fixed_text(sector.nearest_m, 2);
  if (sector.farthest_m - sector.nearest_m > tolerance_m(sector.nearest_m))
    text += " to " + fixed_text(sector.farthest_m, 2);
  return text + " m";
}

}  // namespace

std::string text_of(const std::vector<BodySector>& sectors) {
  std::string text;
  for (std::size_t i = 0; i < std::min(sectors.size(), kMostSectorsInText); ++i)
    text += (i == 0 ? "" : ", ") + text_of(sectors[i]);
  if (sectors.size() > kMostSectorsInText)
    text += ", and " + counted(sectors.size() - kMostSectorsInText, "other sector");
  return text;
}

BearingBins::BearingBins(const std::vector<float>& bearings_rad)
    : first_rad_(static_cast<double>(bearings_rad.front())),
      step_rad_(1),
      size_(bearings_rad.size()),
      is_full_circle_(is_full_circle(bearings_rad)) {
  const double span_rad = static_cast<double>(bearings_rad.back()) - first_rad_;
  if (span_rad != 0) step_rad_ = span_rad / static_cast<double>(size_ - 1);
}

std::optional<std::size_t> BearingBins::bin_of(float bearing_rad) const {
  double steps = (static_cast<double>(bearing_rad) - first_rad_) / step_rad_;
  const auto last = static_cast<double>(size_ - 1);
  if (is_full_circle_ && (steps < 0 || steps > last)) {
    const double round = 2 * M_PI / std::abs(step_rad_);
    steps -= round * std::floor(steps / round);
    if (steps > last) steps = steps - last < round - steps ? last : 0;  // between the last and the first bin
  }
  const long bin = std::lround(steps);
  if (bin < 0 || static_cast<std::size_t>(bin) >= size_) return std::nullopt;
  return static_cast<std::size_t>(bin);
}

std::vector<std::size_t> BearingBins::around(std::size_t bin) const {
  std::vector<std::size_t> bins{bin};
  if (bin > 0 || is_full_circle_) bins.push_back((bin + size_ - 1) % size_);
  if (bin + 1 < size_ || is_full_circle_) bins.push_back((bin + 1) % size_);
  return bins;
}

void OwnBodyMask::add_laser(std::size_t laser, const mrpt::math::TPose2D& robot_T_laser,
                            const BearingBins& bins, const std::vector<double>& body_ranges_m) {
  std::vector<Band> bands(bins.size());
  bool continues = false;
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    const double range_m = body_ranges_m[bin];
    if (range_m == 0) {
      continues = false;
      continue;
    }
    if (!continues) {
      sectors_.push_back({laser, robot_T_laser, 0, bins.bearing_rad(bin), 0, 0, range_m, range_m});
      continues = true;
    }
    BodySector& sector = sectors_.back();
    ++sector.beams;
    sector.to_rad = bins.bearing_rad(bin);
    sector.width_rad += std::abs(bins.step_rad());
    sector.nearest_m = std::min(sector.nearest_m, range_m);
    sector.farthest_m = std::max(sector.farthest_m, range_m);
    const auto from_m = static_cast<float>(range_m - kMaskedTolerances * tolerance_m(range_m));
    const auto to_m = static_cast<float>(range_m + kMaskedTolerances * tolerance_m(range_m));
    for (const std::size_t i : bins.around(bin)) {
      Band& band = bands[i];
      const bool is_empty = band.to_m < band.from_m;
      band = is_empty ? Band{from_m, to_m} : Band{std::min(band.from_m, from_m), std::max(band.to_m, to_m)};
    }
  }
  lasers_.emplace(laser, Laser{bins, std::move(bands)});
}

void OwnBodyMask::apply(LaserScan& scan) const {
  const auto found = lasers_.find(scan.laser);
  if (found == lasers_.end()) return;
  const Laser& laser = found->second;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const auto bin = laser.bins.bin_of((*scan.bearings_rad)[i]);
    float& range_m = scan.ranges_m[i];
    if (bin && range_m >= laser.bands[*bin].from_m && range_m <= laser.bands[*bin].to_m)
      range_m = std::numeric_limits<float>::quiet_NaN();
  }
}

OwnBodyFinder::Laser::Laser(const LaserScan& scan)
    : bins(*scan.bearings_rad), robot_T_laser(scan.robot_T_laser), counts(bins.size() * kCells) {}

/// Turn of the robot from one scan to another; empty if neither odometry nor a gyroscope tells.
std::optional<double> OwnBodyFinder::turn_rad(const Motion& from, const Motion& to) {
  if (from.has_odometry && to.has_odometry)
    return mrpt::math::wrapToPi(to.odom_T_robot.phi - from.odom_T_robot.phi);
  if (from.imu_heading_rad && to.imu_heading_rad)
    return mrpt::math::wrapToPi(*to.imu_heading_rad - *from.imu_heading_rad);
  return std::nullopt;
}

bool OwnBodyFinder::is_key_scan(const Laser& laser, const Motion& motion,
                                const std::vector<float>& ranges_m) {
  if (laser.key_scans == 0) return true;
  const std::optional<double> turn = turn_rad(laser.key, motion);
  if (turn && std::abs(*turn) < kKeyTurn_rad) return false;
  return scene_changed(laser.key_ranges_m, ranges_m, turn ? 0.5 : 0.75);
}

void OwnBodyFinder::take_key_scan(Laser& laser, const Motion& motion, std::vector<float> ranges_m) {
  for (std::size_t bin = 0; bin < ranges_m.size(); ++bin) {
    const double cell = std::floor(static_cast<double>(ranges_m[bin]) / kCell_m);
    if (cell >= 0 && cell < static_cast<double>(kCells))
      ++laser.counts[bin * kCells + static_cast<std::size_t>(cell)];
  }
  if (laser.key_scans > 0) {
    const mrpt::math::TPose2D step = between(laser.key.odom_T_robot, motion.odom_T_robot);
    laser.travelled_m += portable::hypot(step.x, step.y);
    laser.knows_travel = laser.knows_travel && motion.has_odometry && laser.key.has_odometry;
    laser.knows_headings = laser.knows_headings && turn_rad(laser.key, motion).has_value();
  }
  ++laser.key_scans;
  laser.key = motion;
  laser.key_ranges_m = std::move(ranges_m);
}

void OwnBodyFinder::add(const LaserScan& scan, const Motion& motion) {
  if (scan.ranges_m.empty()) return;
  Laser& laser = lasers_.try_emplace(scan.laser, scan).first->second;
  if (laser.key_scans == kMostKeyScans) return;
  std::vector<float> ranges_m = ranges_by_bin(scan, laser.bins);
  if (is_key_scan(laser, motion, ranges_m)) take_key_scan(laser, motion, std::move(ranges_m));
}

void OwnBodyFinder::add(const Frame& frame) {
  ++frames_;
  for_each_scan(frame, frame.odom_T_robot, [&](const LaserScan& scan, const mrpt::math::TPose2D& pose) {
    add(scan, {frame.has_odometry, pose, frame.imu_heading_rad});
  });
}

bool OwnBodyFinder::settled() const {
  if (frames_ >= kMostFrames) return true;
  return !lasers_.empty() && std::all_of(lasers_.begin(), lasers_.end(), [](const auto& laser) {
    return laser.second.key_scans == kMostKeyScans;
  });
}

OwnBodyMask OwnBodyFinder::mask() const {
  OwnBodyMask mask;
  for (const auto& [number, laser] : lasers_) {
    if (laser.knows_travel && laser.travelled_m < kLeastTravel_m) continue;
    const std::size_t least_seen = laser.knows_headings ? kLeastSeen : kLeastSeenWithoutHeading;
    std::vector<double> ranges_m;
    for (std::size_t bin = 0; bin < laser.bins.size(); ++bin)
      ranges_m.push_back(body_range_m(&laser.counts[bin * kCells], least_seen));
    const bool sees_body = std::any_of(ranges_m.begin(), ranges_m.end(), [](double r) { return r > 0; });
    if (sees_body) mask.add_laser(number, laser.robot_T_laser, laser.bins, ranges_m);
  }
  return mask;
}

OwnBodyMask find_own_body(FrameSource& log, std::optional<double> most_s) {
  OwnBodyFinder finder;
  LookOver look_over(most_s.value_or(0));
  try {
    while (!finder.settled()) {
      const std::optional<Frame> frame = log.next();
      if (!frame) break;
      finder.add(*frame);
      look_over.add_scan(frame->time_us);
      if (most_s && look_over.is_enough()) break;
    }
  } catch (const UserError&) {  // damage is reported where the log is mapped or checked
  }
  return finder.mask();
}

}  // namespace psi_slam
