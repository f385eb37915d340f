// SPDX-License-Identifier: BSD-3-Clause
#include "batch/run_figures.h"

#include <algorithm>
#include <nlohmann/json.hpp>

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
        return a.time_us < b.time_us;  // stamps may go back
      });
  return first == path.end() ? 0 : seconds(last->time_us - first->time_us);
}

}  // namespace

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
  Json errors = Json::object();
  for (const PathFigure& figure : kPathFigures) {
    const MeanAndStd& one = figures.errors.*figure.errors;
    errors[figure.key] = {{"mean", one.mean}, {"std", one.std}};
  }
  return {{"errors", errors},
          {"relations_used", figures.relations_used},
          {"relations_skipped", figures.relations_skipped},
          {"scans", figures.scans},
          {"duration_s", figures.duration_s},
          {"wall_s", figures.wall_s},
          {"cpu_s", figures.cpu_s},
          {"peak_memory_mib", figures.peak_memory_mib}};
}

RunFigures read_run_figures(const Json& json) {
  RunFigures figures;
  for (const PathFigure& figure : kPathFigures) {
    const Json& one = json.at("errors").at(figure.key);
    figures.errors.*figure.errors = {one.at("mean").get<double>(), one.at("std").get<double>()};
  }
  json.at("relations_used").get_to(figures.relations_used);
  json.at("relations_skipped").get_to(figures.relations_skipped);
  json.at("scans").get_to(figures.scans);
  json.at("duration_s").get_to(figures.duration_s);
  json.at("wall_s").get_to(figures.wall_s);
  json.at("cpu_s").get_to(figures.cpu_s);
  json.at("peak_memory_mib").get_to(figures.peak_memory_mib);
  return figures;
}

}  // namespace psi_slam
