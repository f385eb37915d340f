// SPDX-License-Identifier: BSD-3-Clause
#include "eval_app.h"

#include <CLI/CLI.hpp>
#include <array>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "base/number_text.h"
#include "document_options.h"
#include "map/trajectory/relations_metric.h"
#include "number_between.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

struct EvalOptions {
  std::string trajectory;
  std::string relations;
  double max_gap_s = kMaxGap_s;
  std::string per_relation;
  bool force = false;
  bool json = false;
};

/// Parses the arguments, without the program's name. Throws CLI::ParseError for wrong usage, --help and
/// --version.
EvalOptions parse(const std::vector<std::string>& arguments, CLI::App& app) {
  EvalOptions options;
  app.add_option(
         "TRAJECTORY", options.trajectory,
         "Trajectory: trajectory.csv of a run, TUM format, lines 'timestamp x y theta', or a corrected "
         "CARMEN log with FLASER lines")
      ->required();
  app.add_option("RELATIONS", options.relations,
                 "Known relative poses: lines 'time1 time2 x y z roll pitch yaw'")
      ->required();
  app.add_option("--max-gap", options.max_gap_s,
                 "Longest gap between two poses that is interpolated, in seconds")
      ->check(number_between(0.0, 1e9))
      ->capture_default_str();
  app.add_option("--per-relation", options.per_relation,
                 "Write the error of each relation to this file (CSV)")
      ->type_name("FILE");
  app.add_flag("--force", options.force, "Replace an existing file of --per-relation");
  app.add_flag("--json", options.json, "Print the result as JSON");
  app.set_version_flag("--version", "psi-slam-eval " PSI_SLAM_VERSION, "Print the version and exit");
  add_document_options(app, {{"The errors were measured.", "Something failed, such as a full disk.",
                              "The arguments, the trajectory or the relations are invalid."}});
  // CLI11 expects the last argument first.
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  return options;
}

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

void evaluate(const EvalOptions& options, std::ostream& out) {
  if (!options.per_relation.empty() && !options.force && std::filesystem::exists(options.per_relation))
    throw UserError(options.per_relation +
                    ": the file exists. Name another file, or replace it with --force");
  const RelationsMetric metric = evaluate_relations(read_trajectory(options.trajectory),
                                                    read_relations(options.relations), options.max_gap_s);
  if (!options.per_relation.empty()) write_text_atomically(options.per_relation, per_relation_csv(metric));
  if (options.json) {
    out << to_json(metric).dump(1) << '\n';
  } else {
    print_table(out, metric);
  }
}

}  // namespace

int run_eval_app(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err) noexcept {
  CLI::App app(
      "Compares a trajectory with known relative poses: the metric of the Freiburg SLAM benchmark "
      "(Kümmerle et al. 2009) and the variant of Cartographer's tool.",
      "psi-slam-eval");
  return run_program(app, out, err, [&] {
    evaluate(parse(arguments, app), out);
    return kExitDone;
  });
}

}  // namespace psi_slam
