// SPDX-License-Identifier: BSD-3-Clause
// Maps degraded logs: with fewer scans, a narrower field of view, noisier odometry or no odometry.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/random_draws.h"
#include "batch/seeds.h"
#include "batch/workers.h"
#include "common/bench_report.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Noise of odometry as a random walk. Errors of successive stretches are independent: their variances grow
/// with the distance and the rotation that odometry measures.
struct OdometryNoise {
  double sigma_m_per_root_m = 0;      ///< standard deviation of the position along each axis after 1 m
  double sigma_rad_per_root_m = 0;    ///< standard deviation of the heading after 1 m straight ahead
  double sigma_rad_per_root_rad = 0;  ///< standard deviation of the heading after 1 rad on the spot
};

/// Measures the noise of odometry against the poses in a map, which count as true. Takes root mean squares
/// over successive stretches of at least 1 m or 1 rad by odometry, scaled to 1 m or 1 rad. Compares motions
/// along the true headings, so that a wrong heading does not add to the error of the position. Splits the
/// error of the heading between distance and rotation by least squares. The split is ambiguous if distance
/// and rotation are always in the same proportion. Zero without a complete stretch. Throws
/// std::invalid_argument if the numbers of poses differ.
OdometryNoise measure_odometry_noise(const std::vector<mrpt::math::TPose2D>& odom_T_robot,
                                     const std::vector<mrpt::math::TPose2D>& map_T_robot);

struct DegradationOptions {
  /// Factor for the error of odometry. Adds normal noise of sqrt(scale^2 - 1) times `natural_noise` to each
  /// step between scans of the log; its variance grows with the distance and rotation of the step. Odometry
  /// stays unchanged for a scale of 1 or less.
  double odometry_noise_scale = 1;
  OdometryNoise natural_noise;
  std::size_t keep_every_nth = 1;           ///< keeps every nth scan, starting with the first
  std::optional<double> field_of_view_rad;  ///< full angle, centred ahead; beams outside become NaN
  bool no_odometry = false;                 ///< removes odometry from the frames
  std::uint64_t seed = 1;                   ///< seed of the noise
};

/// Frame source that degrades the frames of another source.
class DegradedSource : public FrameSource {
 public:
  /// Throws std::invalid_argument if keep_every_nth is 0 or the field of view is not positive.
  DegradedSource(std::unique_ptr<FrameSource> source, const DegradationOptions& options);

  /// Next kept frame. Frame::index counts the kept frames.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  void spoil_odometry(Frame& frame);
  void narrow(LaserScan& scan) const;

  std::unique_ptr<FrameSource> source_;
  DegradationOptions options_;
  RandomDraws draws_;
  std::size_t read_ = 0;
  std::size_t kept_ = 0;
  std::optional<mrpt::math::TPose2D> last_odom_T_robot_;  ///< odometry of the previous frame in the log
  mrpt::math::TPose2D spoilt_odom_T_robot_;
};

/// One way to degrade a log.
struct RobustnessCase {
  std::string series;  ///< name of a curve of the plot: "odometry noise", ...
  std::string name;    ///< label of a point of the curve: "× 2"
  DegradationOptions degradation;
};

/// True if the degraded log depends on the seed.
bool draws_random_numbers(const RobustnessCase& degraded);

/// All cases. Each series starts with the unchanged log. The natural noise is not set: it depends on the log.
std::vector<RobustnessCase> robustness_cases(std::uint64_t seed);

struct RobustnessRow {
  std::string log;
  RobustnessCase degraded;
  std::uint64_t seed = 1;          ///< seed of the noise
  double translation_error_m = 0;  ///< mean over the relations
  double rotation_error_deg = 0;   ///< mean over the relations
  std::size_t relations = 0;       ///< evaluated relations; those in long gaps of the path are not evaluated
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans after the first that the front end could not match
  std::size_t loops = 0;      ///< accepted loops
  std::optional<double> loop_precision;
  std::optional<double> loop_recall;
};

struct RobustnessLog {
  std::string name;
  OdometryNoise natural;  ///< noise of its odometry, measured against the map of the unchanged log
};

struct RobustnessBenchmark {
  std::vector<LogIdentity> identities;
  std::vector<std::string> without_relations;  ///< logs that cannot be evaluated
  std::vector<RobustnessLog> logs;
  std::vector<RobustnessRow> rows;  ///< ordered by log, case and seed
};

/// Maps each log once for each different case, or once for each seed if the case draws random numbers. Throws
/// UserError as open_log() and read_relations().
RobustnessBenchmark run_robustness_benchmark(const std::vector<BenchmarkLog>& logs, const SeedRange& seeds,
                                             const ProgressObserver& observer);

/// The report of the `robustness` command. In JSON, "logs" has the natural noise of each log's odometry, and
/// "rows" has the statistics over the seeds of each case: {"mean", "std", "min", "max"}. A precision or
/// recall without loops or relations is null. Each series has a plot of the error of each log.
BenchReport robustness_report(const RobustnessBenchmark& benchmark, const SeedRange& seeds,
                              const std::string& machine);

}  // namespace psi_slam
