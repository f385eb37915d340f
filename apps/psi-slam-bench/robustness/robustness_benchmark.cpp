// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/degrees.h"
#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/unmatched_scans.h"
#include "map/trajectory/loop_judgement.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kStretch_m = 1;
constexpr double kStretch_rad = 1;

/// A stretch of the path and the error of odometry over it. Sums the errors of the steps in the frame of the
/// map. A wrong heading therefore does not add to the error of the position.
struct Stretch {
  double way_m = 0;     // length by odometry, which has no jitter while the robot stands
  double turn_rad = 0;  // sum of absolute rotations
  double off_x_m = 0;
  double off_y_m = 0;
  double off_rad = 0;

  void add(const TPose2D& odometry_motion, const TPose2D& map_motion, double map_heading_rad) {
    way_m += portable::hypot(odometry_motion.x, odometry_motion.y);
    turn_rad += std::abs(mrpt::math::wrapToPi(odometry_motion.phi));
    const TPose2D off = compose(TPose2D(0, 0, map_heading_rad), TPose2D(odometry_motion.x - map_motion.x,
                                                                        odometry_motion.y - map_motion.y, 0));
    off_x_m += off.x;
    off_y_m += off.y;
    off_rad += mrpt::math::wrapToPi(odometry_motion.phi - map_motion.phi);
  }
};

std::vector<Stretch> stretches_of(const std::vector<TPose2D>& odom_T_robot,
                                  const std::vector<TPose2D>& map_T_robot) {
  std::vector<Stretch> stretches;
  Stretch stretch;
  for (std::size_t i = 1; i < map_T_robot.size(); ++i) {
    stretch.add(between(odom_T_robot[i - 1], odom_T_robot[i]), between(map_T_robot[i - 1], map_T_robot[i]),
                map_T_robot[i - 1].phi);
    if (stretch.way_m < kStretch_m && stretch.turn_rad < kStretch_rad) continue;
    stretches.push_back(stretch);
    stretch = {};
  }
  return stretches;
}

/// Splits heading errors into variances a per metre and b per radian: least squares of
/// off_rad^2 = a way_m + b turn_rad with a, b >= 0.
void split_heading(const std::vector<Stretch>& stretches, OdometryNoise& noise) {
  double ww = 0, wt = 0, tt = 0, we = 0, te = 0;
  for (const Stretch& stretch : stretches) {
    const double squared_rad2 = stretch.off_rad * stretch.off_rad;
    ww += stretch.way_m * stretch.way_m;
    wt += stretch.way_m * stretch.turn_rad;
    tt += stretch.turn_rad * stretch.turn_rad;
    we += stretch.way_m * squared_rad2;
    te += stretch.turn_rad * squared_rad2;
  }
  const double determinant = ww * tt - wt * wt;
  double a = determinant > 1e-9 * ww * tt ? (we * tt - te * wt) / determinant : -1;
  double b = determinant > 1e-9 * ww * tt ? (te * ww - we * wt) / determinant : -1;
  if (a < 0 || b < 0) {  // no variance is negative: fits only one of a and b
    const bool way_only = a >= 0 || (b < 0 && ww >= tt);
    a = way_only && ww > 0 ? we / ww : 0;
    b = !way_only && tt > 0 ? te / tt : 0;
  }
  noise.sigma_rad_per_root_m = std::sqrt(a);
  noise.sigma_rad_per_root_rad = std::sqrt(b);
}

bool is_the_log_itself(const DegradationOptions& degradation) {
  return degradation.odometry_noise_scale <= 1 && degradation.keep_every_nth == 1 &&
         !degradation.field_of_view_rad && !degradation.no_odometry;
}

OdometryNoise natural_noise(const std::vector<FrameRecord>& frames) {
  std::vector<mrpt::math::TPose2D> odometry;
  std::vector<mrpt::math::TPose2D> map;
  for (const FrameRecord& frame : frames) {
    odometry.push_back(frame.odom_T_robot);
    map.push_back(frame.map_T_robot);
  }
  return measure_odometry_noise(odometry, map);
}

RobustnessRow row_of(const MappingResult& result, const std::vector<Relation>& relations) {
  RobustnessRow row;
  const RelationsMetric metric = error_of(result.frames, relations);
  row.translation_error_m = metric.translation_abs_m.mean;
  row.rotation_error_deg = metric.rotation_abs_deg.mean;
  row.relations = metric.exact + metric.interpolated;
  row.scans = result.frames.size();
  row.unmatched = unmatched_scans(result.frames, runs_of(result)).count;
  const LoopJudgement judgement = judge_loops(result, relations);
  row.loops = judgement.judged.size() + judgement.unjudged;
  row.loop_precision = judgement.precision();
  row.loop_recall = judgement.recall();
  return row;
}

/// Runs in the order of their cases. A case that draws random numbers has a run for each seed, and any other
/// case has one run with the first seed.
std::vector<RobustnessCase> runs_of(const SeedRange& seeds) {
  std::vector<RobustnessCase> runs;
  for (RobustnessCase degraded : robustness_cases(seeds.first))
    for (const std::uint64_t seed : seeds.all()) {
      if (seed > seeds.first && !draws_random_numbers(degraded)) break;
      degraded.degradation.seed = seed;
      runs.push_back(degraded);
    }
  return runs;
}

}  // namespace

OdometryNoise measure_odometry_noise(const std::vector<TPose2D>& odom_T_robot,
                                     const std::vector<TPose2D>& map_T_robot) {
  if (odom_T_robot.size() != map_T_robot.size())
    throw std::invalid_argument("measure_odometry_noise: odometry and map have different numbers of poses");
  const std::vector<Stretch> stretches = stretches_of(odom_T_robot, map_T_robot);
  OdometryNoise noise;
  double way_m = 0;
  double squared_m2 = 0;
  for (const Stretch& stretch : stretches) {
    way_m += stretch.way_m;
    squared_m2 += stretch.off_x_m * stretch.off_x_m + stretch.off_y_m * stretch.off_y_m;
  }
  if (way_m > 0) noise.sigma_m_per_root_m = std::sqrt(squared_m2 / (2 * way_m));
  split_heading(stretches, noise);
  return noise;
}

DegradedSource::DegradedSource(std::unique_ptr<FrameSource> source, const DegradationOptions& options)
    : source_(std::move(source)), options_(options), draws_(options.seed, "odometry", 0) {
  if (options.keep_every_nth == 0) throw std::invalid_argument("DegradedSource: no scan would be kept");
  if (options.field_of_view_rad && !(*options.field_of_view_rad > 0))
    throw std::invalid_argument("DegradedSource: the field of view must be positive");
}

std::optional<Frame> DegradedSource::next() {
  while (auto frame = source_->next()) {
    spoil_odometry(*frame);  // also for skipped frames: the noise must not depend on keep_every_nth
    if (read_++ % options_.keep_every_nth != 0) continue;
    frame->index = kept_++;
    narrow(frame->scan);
    for (CompanionScan& companion : frame->companions) narrow(companion.scan);
    return frame;
  }
  return std::nullopt;
}

void DegradedSource::spoil_odometry(Frame& frame) {
  if (options_.no_odometry) {
    frame.has_odometry = false;
    frame.odom_T_robot = {};
    for (CompanionScan& companion : frame.companions) companion.frame_T_robot = {};
    return;
  }
  if (!(options_.odometry_noise_scale > 1)) return;
  const TPose2D odom_T_robot = frame.odom_T_robot;
  if (!last_odom_T_robot_) {
    spoilt_odom_T_robot_ = odom_T_robot;
  } else {
    const double share = std::sqrt(options_.odometry_noise_scale * options_.odometry_noise_scale - 1);
    const OdometryNoise& natural = options_.natural_noise;
    TPose2D motion = between(*last_odom_T_robot_, odom_T_robot);
    const double way_m = portable::hypot(motion.x, motion.y);
    const double turn_rad = std::abs(mrpt::math::wrapToPi(motion.phi));
    const double sigma_m = share * natural.sigma_m_per_root_m * std::sqrt(way_m);
    const double sigma_rad = share * portable::hypot(natural.sigma_rad_per_root_m * std::sqrt(way_m),
                                                     natural.sigma_rad_per_root_rad * std::sqrt(turn_rad));
    motion.x += sigma_m * draws_.normal();
    motion.y += sigma_m * draws_.normal();
    motion.phi += sigma_rad * draws_.normal();
    spoilt_odom_T_robot_ = compose(spoilt_odom_T_robot_, motion);
    spoilt_odom_T_robot_.normalizePhi();
  }
  last_odom_T_robot_ = odom_T_robot;
  frame.odom_T_robot = spoilt_odom_T_robot_;
}

void DegradedSource::narrow(LaserScan& scan) const {
  if (!options_.field_of_view_rad || !scan.bearings_rad) return;
  constexpr double kRounding_rad = 1e-5;  // bearings are floats
  const std::size_t beams = std::min(scan.ranges_m.size(), scan.bearings_rad->size());
  for (std::size_t i = 0; i < beams; ++i)
    if (std::abs(static_cast<double>((*scan.bearings_rad)[i])) >
        *options_.field_of_view_rad / 2 + kRounding_rad)
      scan.ranges_m[i] = std::numeric_limits<float>::quiet_NaN();
}

std::vector<RobustnessCase> robustness_cases(std::uint64_t seed) {
  std::vector<RobustnessCase> cases;
  DegradationOptions as_it_is;
  as_it_is.seed = seed;
  for (const double scale : {1.0, 2.0, 4.0}) {
    cases.push_back({"odometry noise", "× " + fixed_text(scale, 0), as_it_is});
    cases.back().degradation.odometry_noise_scale = scale;
  }
  cases.push_back({"odometry noise", "no odometry", as_it_is});
  cases.back().degradation.no_odometry = true;
  for (const std::size_t nth : {1U, 2U, 3U, 5U}) {
    cases.push_back({"scans kept", "1 of " + std::to_string(nth), as_it_is});
    cases.back().degradation.keep_every_nth = nth;
  }
  cases.push_back({"field of view", "full", as_it_is});
  cases.push_back({"field of view", "90°", as_it_is});
  cases.back().degradation.field_of_view_rad = radians_from_degrees(90.0L);
  return cases;
}

bool draws_random_numbers(const RobustnessCase& degraded) {
  return degraded.degradation.odometry_noise_scale > 1;
}

RobustnessBenchmark run_robustness_benchmark(const std::vector<BenchmarkLog>& logs, const SeedRange& seeds,
                                             const ProgressObserver& observer) {
  const std::vector<RobustnessCase> runs = runs_of(seeds);
  const auto own = std::count_if(runs.begin(), runs.end(), [](const RobustnessCase& degraded) {
    return !is_the_log_itself(degraded.degradation);
  });
  const double all = static_cast<double>(logs.size()) * static_cast<double>(own + 1);
  double done = 0;
  RobustnessBenchmark benchmark;
  benchmark.identities = identities_of(logs);
  for (const BenchmarkLog& log : logs) {
    const Settings settings = benchmark_settings(log.ini);
    const std::vector<Relation> relations = read_relations(log.relations.value());
    const auto map = [&](const DegradationOptions& degradation, const std::string& doing) {
      DegradedSource source(open_log(log.log, log_options(settings)), degradation);
      return map_source(source, mapper_options(settings),
                        [&](double share) { observer(log.name + ", " + doing, done + share, all); });
    };
    MappingResult unchanged = map({}, "as it is");
    const OdometryNoise natural = natural_noise(unchanged.frames);
    const RobustnessRow as_it_is = row_of(unchanged, relations);
    unchanged = {};  // frees its memory
    ++done;
    benchmark.logs.push_back({log.name, natural});
    for (RobustnessCase degraded : runs) {
      degraded.degradation.natural_noise = natural;
      RobustnessRow row = as_it_is;
      if (!is_the_log_itself(degraded.degradation)) {
        row = row_of(map(degraded.degradation, degraded.series + ' ' + degraded.name), relations);
        ++done;
      }
      row.log = log.name;
      row.seed = degraded.degradation.seed;
      row.degraded = std::move(degraded);
      benchmark.rows.push_back(std::move(row));
    }
  }
  return benchmark;
}

}  // namespace psi_slam
