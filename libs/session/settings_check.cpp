// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <thread>

#include "base/number_text.h"
#include "psi_slam/user_error.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

/// Value and name of an option.
struct Named {
  const char* name;
  double value;
  bool is_angle = false;

  std::string words() const {
    return std::string(name) + " = " + (is_angle ? exact_degrees_text(value) : exact_text(value));
  }
};

void require_below(const Named& smaller, const Named& larger) {
  if (!(smaller.value < larger.value))
    throw UserError(smaller.words() + " must be less than " + larger.words());
}

void require_at_most(const Named& smaller, const Named& larger) {
  if (!(smaller.value <= larger.value))
    throw UserError(smaller.words() + " must not be more than " + larger.words());
}

void check_ranges(const Settings& settings) {
  const LogOptions& log = settings.log;
  const ScanFilterOptions& scan = settings.mapper.front_end.scan;
  if (log.max_range_m)
    require_below({"log.min_range_m", log.min_range_m}, {"log.max_range_m", *log.max_range_m});
  require_below({"front_end.min_range_m", scan.min_range_m}, {"front_end.max_range_m", scan.max_range_m});
  require_below({"log.min_range_m", log.min_range_m}, {"front_end.max_range_m", scan.max_range_m});
  if (log.max_range_m)
    require_below({"front_end.min_range_m", scan.min_range_m}, {"log.max_range_m", *log.max_range_m});
}

void check_windows(const MapperOptions& mapper) {
  const FrontEndOptions& front_end = mapper.front_end;
  const LoopCandidateOptions& loops = mapper.back_end.loop_closure.candidates;
  require_at_most({"front_end.window_m", front_end.window_m},
                  {"front_end.max_window_m", front_end.max_window_m});
  require_at_most({"front_end.window_theta_deg", front_end.window_rad, true},
                  {"front_end.max_window_theta_deg", front_end.max_window_rad, true});
  require_at_most({"loop_closure.min_window_m", loops.min_window_m},
                  {"loop_closure.window_x_m", loops.max_window.x_m});
  require_at_most({"loop_closure.min_window_m", loops.min_window_m},
                  {"loop_closure.window_y_m", loops.max_window.y_m});
  require_at_most({"loop_closure.min_window_theta_deg", loops.min_window_rad, true},
                  {"loop_closure.window_theta_deg", loops.max_window.theta_rad, true});
  require_at_most({"final_search.window_m", mapper.back_end.final_search.window_m},
                  {"verification.wide_window_m", mapper.back_end.loop_closure.verification.wide_window_m});
}

void check_matchers(const MapperOptions& mapper) {
  const MatcherOptions& matcher = mapper.back_end.loop_matcher;
  require_at_most({"loop_closure.min_sigma_m", matcher.min_sigma_m},
                  {"loop_closure.max_sigma_m", matcher.max_sigma_m});
  require_below({"psi.psi_1", mapper.back_end.psi.psi_1}, {"psi.psi_2", mapper.back_end.psi.psi_2});
}

}  // namespace

void check_values(const Settings& settings) {
  check_ranges(settings);
  check_windows(settings.mapper);
  check_matchers(settings.mapper);
  check_log_options(log_options(settings));
}

LogOptions log_options(const Settings& settings) {
  LogOptions options = settings.log;
  const LaserMount& mount = settings.laser_mount;
  if (mount.x_m || mount.y_m || mount.yaw_rad)
    options.robot_T_laser =
        mrpt::math::TPose2D(mount.x_m.value_or(0), mount.y_m.value_or(0), mount.yaw_rad.value_or(0));
  return options;
}

MapperOptions mapper_options(const Settings& settings) {
  MapperOptions options = settings.mapper;
  options.back_end.seed = settings.run.seed;
  options.back_end.threads = worker_threads(settings.run);
  return options;
}

LocalizerOptions localizer_options(const Settings& settings) {
  LocalizerOptions options = settings.localization;
  options.front_end = settings.mapper.front_end;
  options.consensus = settings.mapper.back_end.loop_consensus;
  options.search.genetic = settings.mapper.back_end.genetic;
  options.search.match = settings.mapper.back_end.loop_matcher;
  options.search.smoothing_sigma_m = settings.mapper.front_end.local_map.smoothing_sigma_m;
  options.seed = settings.run.seed;
  return options;
}

int worker_threads(const RunOptions& run) {
  if (run.threads > 0) return run.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace psi_slam
