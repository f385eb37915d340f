// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/relations_metric.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "map/trajectory/text_lines.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kRelationWords = 8;

RelationError error_of(const Relation& relation, const PoseAtTime& pose1, const PoseAtTime& pose2) {
  const TPose2D& truth = relation.pose1_T_pose2;
  const TPose2D estimate = between(pose1.pose, pose2.pose);
  const TPose2D error = between(truth, estimate);                        // truth^-1 * estimate
  const TPose2D cartographer_error = compose(estimate, inverse(truth));  // estimate * truth^-1
  RelationError result;
  result.relation = relation;
  result.interpolated = pose1.interpolated || pose2.interpolated;
  result.translation_m = portable::hypot(error.x, error.y);
  result.rotation_deg = std::abs(mrpt::math::wrapToPi(error.phi)) * (180 / M_PI);
  result.cartographer_translation_m = portable::hypot(cartographer_error.x, cartographer_error.y);
  return result;
}

/// Summarises the member `value` of all errors, and its squares.
void summarize_value(const std::vector<RelationError>& errors, double RelationError::*value,
                     ErrorSummary& plain, ErrorSummary& squared) {
  std::vector<double> values;
  std::vector<double> squares;
  for (const RelationError& error : errors) {
    values.push_back(error.*value);
    squares.push_back(error.*value * error.*value);
  }
  plain = summarize(std::move(values));
  squared = summarize(std::move(squares));
}

UserError nothing_matches(const Trajectory& sorted, const std::vector<Relation>& relations) {
  TimeUs first = relations.front().time1_us;
  TimeUs last = first;
  for (const Relation& relation : relations) {
    first = std::min({first, relation.time1_us, relation.time2_us});
    last = std::max({last, relation.time1_us, relation.time2_us});
  }
  return UserError("none of the " + std::to_string(relations.size()) +
                   " relations has both its times in the trajectory. The trajectory runs from " +
                   format_seconds(sorted.front().time_us) + " s to " + format_seconds(sorted.back().time_us) +
                   " s, the relations from " + format_seconds(first) + " s to " + format_seconds(last) +
                   " s. Check that both files belong to the same log");
}

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& path) {
  std::vector<Relation> relations;
  for_each_text_line(path, [&](const TextLine& line) {
    if (line.words.size() != kRelationWords)
      throw line.error("expected 'time1 time2 x y z roll pitch yaw', found " +
                       counted(line.words.size(), "word"));
    for (const std::size_t out_of_plane : {4, 5, 6}) line.finite_number(out_of_plane, "z, roll or pitch");
    relations.push_back({line.time(0),
                         line.time(1),
                         {line.finite_number(2, "x in metres"), line.finite_number(3, "y in metres"),
                          mrpt::math::wrapToPi(line.finite_number(7, "yaw in radians"))}});
  });
  if (relations.empty())
    throw UserError(path.string() + ": no relation found. Expected lines 'time1 time2 x y z roll pitch yaw'");
  return relations;
}

ErrorSummary summarize(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("summarize: no values");
  const double n = static_cast<double>(values.size());
  ErrorSummary summary;
  summary.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double value : values) squares += (value - summary.mean) * (value - summary.mean);
  summary.std = std::sqrt(squares / n);
  std::sort(values.begin(), values.end());
  summary.median = values[values.size() / 2];
  summary.p95 = values[std::min(values.size() - 1, static_cast<std::size_t>(0.95 * n))];
  summary.max = values.back();
  return summary;
}

RelationsMetric evaluate_relations(Trajectory trajectory, const std::vector<Relation>& relations,
                                   double max_gap_s) {
  if (trajectory.empty() || relations.empty())
    throw UserError("the metric needs a trajectory and relations, found " +
                    std::to_string(trajectory.size()) + " poses and " + std::to_string(relations.size()) +
                    " relations. Give a trajectory with poses and a file with relations of the same log");
  constexpr double kLongest_s = 1e9;
  if (!(max_gap_s >= 0)) throw std::invalid_argument("evaluate_relations: max_gap_s must not be negative");
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time_us < b.time_us; });
  const TimeUs max_gap_us = std::llround(std::min(max_gap_s, kLongest_s) * 1e6);

  RelationsMetric metric;
  for (const Relation& relation : relations) {
    const auto pose1 = pose_at_time(trajectory, relation.time1_us, max_gap_us);
    const auto pose2 = pose_at_time(trajectory, relation.time2_us, max_gap_us);
    if (!pose1 || !pose2) {
      ++metric.skipped;
      continue;
    }
    metric.errors.push_back(error_of(relation, *pose1, *pose2));
    ++(metric.errors.back().interpolated ? metric.interpolated : metric.exact);
  }
  if (metric.errors.empty()) throw nothing_matches(trajectory, relations);

  summarize_value(metric.errors, &RelationError::translation_m, metric.translation_abs_m,
                  metric.translation_sq_m2);
  summarize_value(metric.errors, &RelationError::rotation_deg, metric.rotation_abs_deg,
                  metric.rotation_sq_deg2);
  summarize_value(metric.errors, &RelationError::cartographer_translation_m,
                  metric.cartographer_translation_abs_m, metric.cartographer_translation_sq_m2);
  return metric;
}

}  // namespace psi_slam
