// SPDX-License-Identifier: BSD-3-Clause
#include "batch/run_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

PathErrors path_errors(const RelationsMetric& metric) {
  const auto of = [](const ErrorSummary& summary) { return MeanAndStd{summary.mean, summary.std}; };
  return {of(metric.translation_abs_m), of(metric.translation_sq_m2), of(metric.rotation_abs_deg),
          of(metric.rotation_sq_deg2), of(metric.cartographer_translation_abs_m)};
}

double duration_s(const Trajectory& path) {
  const auto [first, last] =
      std::minmax_element(path.begin(), path.end(), [](const StampedPose& a, const StampedPose& b) {
        return a.time_us < b.time_us;  // the time stamps of a path may decrease
      });
  return first == path.end() ? 0 : seconds(last->time_us - first->time_us);
}

/// Calls visit(key, member) for each figure except the errors.
template <class Figures, class Visit>
void visit_counts(Figures& figures, const Visit& visit) {
  visit("relations_used", figures.relations_used);
  visit("relations_skipped", figures.relations_skipped);
  visit("scans", figures.scans);
  visit("duration_s", figures.duration_s);
  visit("wall_s", figures.wall_s);
  visit("cpu_s", figures.cpu_s);
  visit("peak_memory_mib", figures.peak_memory_mib);
}

}  // namespace

std::string errors_text(const MeanAndStd& errors) {
  return fixed_text(errors.mean, 4) + " ± " + fixed_text(errors.std, 4);
}

RunFigures evaluate_path(const Trajectory& path, const std::vector<Relation>& relations) {
  const RelationsMetric metric = evaluate_relations(path, relations);
  RunFigures figures;
  figures.errors = path_errors(metric);
  figures.relations_used = metric.exact + metric.interpolated;
  figures.relations_skipped = metric.skipped;
  figures.scans = path.size();
  figures.duration_s = duration_s(path);
  return figures;
}

Json run_figures_json(const RunFigures& figures) {
  Json json = {{"errors", Json::object()}};
  for (const PathFigure& figure : kPathFigures) {
    const MeanAndStd& errors = figures.errors.*figure.errors;
    json["errors"][figure.key] = {{"mean", errors.mean}, {"std", errors.std}};
  }
  visit_counts(figures, [&json](const char* key, const auto& value) { json[key] = value; });
  return json;
}

RunFigures read_run_figures(const Json& json) {
  RunFigures figures;
  for (const PathFigure& figure : kPathFigures) {
    const Json& errors = json.at("errors").at(figure.key);
    figures.errors.*figure.errors = {errors.at("mean").get<double>(), errors.at("std").get<double>()};
  }
  visit_counts(figures, [&json](const char* key, auto& value) { json.at(key).get_to(value); });
  return figures;
}

}  // namespace psi_slam
