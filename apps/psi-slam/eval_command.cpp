// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/number_text.h"
#include "commands.h"
#include "map/trajectory/relations_metric.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

std::string per_relation_csv(const RelationsMetric& metric) {
  std::string text = "time1,time2,translation_m,rotation_deg,cartographer_translation_m,interpolated\n";
  for (const RelationError& error : metric.errors)
    text += format_seconds(error.relation.time1_us) + ',' + format_seconds(error.relation.time2_us) + ',' +
            fixed_text(error.translation_m, 9) + ',' + fixed_text(error.rotation_deg, 9) + ',' +
            fixed_text(error.cartographer_translation_m, 9) + (error.interpolated ? ",1\n" : ",0\n");
  return text;
}

/// A figure of the metric.
struct Row {
  const char* key;   // key in JSON
  const char* name;  // name in the table
  ErrorSummary RelationsMetric::*summary;
};

constexpr std::array<Row, 6> kRows{
    {{"translation_abs_m", "translation, absolute [m]", &RelationsMetric::translation_abs_m},
     {"translation_sq_m2", "translation, squared [m^2]", &RelationsMetric::translation_sq_m2},
     {"rotation_abs_deg", "rotation, absolute [deg]", &RelationsMetric::rotation_abs_deg},
     {"rotation_sq_deg2", "rotation, squared [deg^2]", &RelationsMetric::rotation_sq_deg2},
     {"cartographer_translation_abs_m", "translation, absolute [m]",
      &RelationsMetric::cartographer_translation_abs_m},
     {"cartographer_translation_sq_m2", "translation, squared [m^2]",
      &RelationsMetric::cartographer_translation_sq_m2}}};

nlohmann::ordered_json to_json(const RelationsMetric& metric) {
  nlohmann::ordered_json json{{"relations",
                               {{"used", metric.exact + metric.interpolated},
                                {"exact", metric.exact},
                                {"interpolated", metric.interpolated},
                                {"skipped", metric.skipped}}}};
  for (const Row& row : kRows) {
    const ErrorSummary& summary = metric.*row.summary;
    json[row.key] = {{"mean", summary.mean},
                     {"std", summary.std},
                     {"median", summary.median},
                     {"p95", summary.p95},
                     {"max", summary.max}};
  }
  return json;
}

void print_table(std::ostream& out, const RelationsMetric& metric) {
  out << "relations: " << metric.exact + metric.interpolated << " used (" << metric.interpolated
      << " of them interpolated), " << metric.skipped << " skipped (outside the trajectory or in a gap)\n\n"
      << "                                     mean ± std             median       95 %        max\n"
      << "Kümmerle et al. 2009\n";
  for (const Row& row : kRows) {
    if (row.summary == &RelationsMetric::cartographer_translation_abs_m)
      out << "Cartographer's variant (with equal rotation)\n";
    const ErrorSummary& summary = metric.*row.summary;
    out << "  " << std::left << std::setw(28) << row.name << std::right << std::setw(11)
        << fixed_text(summary.mean, 4) << " ± " << std::left << std::setw(11) << fixed_text(summary.std, 4)
        << std::right;
    for (const double value : {summary.median, summary.p95, summary.max})
      out << std::setw(11) << fixed_text(value, 4);
    out << '\n';
  }
}

}  // namespace

int evaluate_path(const CommandLine& line, const Streams& streams) {
  const EvalArguments& eval = line.eval;
  if (!eval.per_relation.empty() && !line.force && std::filesystem::exists(eval.per_relation))
    throw UserError(eval.per_relation + ": the file exists. Name another file, or replace it with --force");
  const RelationsMetric metric =
      evaluate_relations(read_trajectory(eval.trajectory), read_relations(eval.relations), eval.max_gap_s);
  if (!eval.per_relation.empty()) write_text_atomically(eval.per_relation, per_relation_csv(metric));
  if (line.json)
    streams.out << to_json(metric).dump(1) << '\n';
  else
    print_table(streams.out, metric);
  return kExitDone;
}

}  // namespace psi_slam
