// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/laser_faults.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <cstddef>
#include <memory>

#include "base/portable_math.h"
#include "logs/doctor/input_doctor.h"
#include "logs/frames/aligned_steps.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_reader.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

constexpr std::size_t kEnoughCompared = 30;  // of each kind of motion
constexpr std::size_t kFewestCompared = 10;
constexpr std::size_t kMostCompared = 400;
constexpr double kComparedDeviation_m = 0.02;
const double kComparedDeviation_rad = DEG2RAD(0.5);
// Odometry that slips deviates by less in most pairs.
constexpr double kTolerance = 0.3;  // of the motion
constexpr double kTolerance_m = 0.03;
const double kTolerance_rad = DEG2RAD(1.5);

/// Pairs of scans with one kind of motion.
struct Comparison {
  std::size_t pairs = 0;
  std::size_t contradicting = 0;

  void add(bool agrees) {
    ++pairs;
    if (!agrees) ++contradicting;
  }
  bool is_enough() const { return pairs >= kEnoughCompared; }
  bool is_suspicious() const { return pairs >= kFewestCompared && 2 * contradicting > pairs; }
};

/// Returns whether scans and odometry move differently in most pairs of scans of the beginning of the log.
bool contradicts_odometry(const std::filesystem::path& path, const LogOptions& options,
                          const ShareObserver& progress) {
  std::unique_ptr<FrameSource> log;
  if (stated_delays(options).empty())
    log = open_log_reader(path, options);
  else
    log = open_log(path, options);  // removes them
  AlignedSteps steps(*log, kComparedMotion_m, kComparedTurn_rad);
  Comparison straight;
  Comparison turns;
  for (std::size_t pairs = 0; pairs < kMostCompared && !(straight.is_enough() && turns.is_enough());
       ++pairs) {
    const std::optional<AlignedStep> step = steps.next();
    if (!step) break;
    if (progress) progress(log->progress());
    const TPose2D& motion = step->by_odometry;
    const ScanAlignment& alignment = step->by_scans;
    if (!alignment.is_reliable()) continue;
    const TPose2D off = step->difference();
    if (std::abs(motion.phi) > kComparedTurn_rad / 2 &&
        alignment.heading_deviation_rad() < kComparedDeviation_rad)
      turns.add(std::abs(off.phi) < kTolerance_rad + kTolerance * std::abs(motion.phi));
    const double direction_rad = portable::atan2(motion.y, motion.x) - step->robot_T_laser.phi;
    if (motion.norm() > kComparedMotion_m / 2 &&
        alignment.deviation_along_m(direction_rad) < kComparedDeviation_m)
      straight.add(off.norm() < kTolerance_m + kTolerance * motion.norm());
  }
  return straight.is_suspicious() || turns.is_suspicious();
}

}  // namespace

LaserFaults find_laser_faults(const std::filesystem::path& path, const LogOptions& options,
                              const ShareObserver& progress) {
  LaserFaults faults;
  const bool states_beams = options.field_of_view_rad || options.beam_angles != BeamAngles::kAuto;
  const bool states_mount = options.robot_T_laser || !options.laser_mounts.empty();
  if (states_beams && states_mount) return faults;
  try {
    if (combines_lasers(path, options) || !contradicts_odometry(path, options, part_of(progress, 0, 0.5)))
      return faults;
    const LogDiagnosis diagnosis = diagnose(path, options, part_of(progress, 0.5, 1));
    if (diagnosis.field_of_view.finds_fault() && !states_beams) {
      faults.stated_field_of_view_rad = diagnosis.field_of_view.fits.front().field_of_view_rad;
      if (!diagnosis.facts.contents.states_beam_angles) faults.assumed_for_beams = diagnosis.facts.beams;
      faults.field_of_view_rad = diagnosis.field_of_view.fits[diagnosis.field_of_view.best].field_of_view_rad;
    }
    faults.stated_mount = diagnosis.facts.robot_T_laser;
    if (diagnosis.laser_is_turned && !states_mount) faults.mount = diagnosis.mount;
  } catch (const UserError&) {  // mapping says so
  }
  return faults;
}

}  // namespace psi_slam
