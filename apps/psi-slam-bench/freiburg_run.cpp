// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg_run.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "benchmark_logs.h"
#include "mapped_run.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/results/loop_judgement.h"
#include "psi_slam/session/mapping_session.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

double duration_s(const std::vector<FrameRecord>& frames) {
  const auto [first, last] =
      std::minmax_element(frames.begin(), frames.end(), [](const FrameRecord& a, const FrameRecord& b) {
        return a.time_us < b.time_us;  // stamps may go back
      });
  return first == frames.end() ? 0 : seconds(last->time_us - first->time_us);
}

}  // namespace

const std::vector<std::string>& freiburg_matchers() {
  static const std::vector<std::string> kMatchers{"csm", "csm_ga", "ga", "adaptive", "adaptive_paper"};
  return kMatchers;
}

bool draws_random_numbers(const std::string& matcher) {
  return matcher != "csm";
}

Settings settings_of(const FreiburgRun& run) {
  const bool paper = run.matcher == "adaptive_paper";
  std::vector<std::string> assignments{"loop_closure.matcher=" + (paper ? "adaptive" : run.matcher),
                                       "run.seed=" + std::to_string(run.seed),
                                       "run.threads=" + std::to_string(run.threads)};
  if (paper) assignments.emplace_back("genetic.variant=paper");
  return benchmark_settings(run.ini, assignments);
}

std::string settings_text(const Settings& settings) {
  Settings bound;
  OptionTable table;
  describe(table, bound);
  bound = settings;
  std::string text;
  for (const OptionSection& section : table.sections())
    for (const Option& option : section.options) text += option.name() + " = " + option.text() + '\n';
  return text;
}

PathErrors path_errors(const RelationsMetric& metric) {
  const auto of = [](const ErrorSummary& summary) { return MeanAndStd{summary.mean, summary.std}; };
  return {of(metric.translation_abs_m), of(metric.translation_sq_m2), of(metric.rotation_abs_deg),
          of(metric.rotation_sq_deg2), of(metric.cartographer_translation_abs_m)};
}

FreiburgFigures map_and_evaluate(const FreiburgRun& run) {
  const std::vector<Relation> relations = read_relations(run.relations);
  MappingSession session(run.log, settings_of(run));
  while (session.step()) {
  }
  if (session.broken_off()) throw UserError(*session.broken_off());
  session.finish();

  const MappingResult& result = session.result();
  const RelationsMetric metric = error_of(result.frames, relations);
  FreiburgFigures figures;
  figures.errors = path_errors(metric);
  figures.relations_used = metric.exact + metric.interpolated;
  figures.relations_skipped = metric.skipped;
  figures.scans = result.frames.size();
  figures.duration_s = duration_s(result.frames);
  figures.loops_accepted = loops_accepted(result);
  const LoopJudgement judgement = judge_loops(result, relations);
  figures.loops_judged = judgement.judged.size();
  figures.loops_false = judgement.false_ones.size();
  figures.loop_recall = judgement.recall();
  return figures;
}

std::string figures_json(const FreiburgFigures& figures) {
  Json errors = Json::object();
  for (const PathFigure& figure : kPathFigures) {
    const MeanAndStd& one = figures.errors.*figure.errors;
    errors[figure.key] = {{"mean", one.mean}, {"std", one.std}};
  }
  return Json{{"errors", errors},
              {"relations_used", figures.relations_used},
              {"relations_skipped", figures.relations_skipped},
              {"scans", figures.scans},
              {"duration_s", figures.duration_s},
              {"loops_accepted", figures.loops_accepted},
              {"loops_judged", figures.loops_judged},
              {"loops_false", figures.loops_false},
              {"loop_recall", figures.loop_recall ? Json(*figures.loop_recall) : Json(nullptr)},
              {"wall_s", figures.wall_s},
              {"cpu_s", figures.cpu_s},
              {"peak_memory_mib", figures.peak_memory_mib}}
      .dump();
}

std::optional<FreiburgFigures> read_figures(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    FreiburgFigures figures;
    for (const PathFigure& figure : kPathFigures) {
      const Json& one = json.at("errors").at(figure.key);
      figures.errors.*figure.errors = {one.at("mean").get<double>(), one.at("std").get<double>()};
    }
    json.at("relations_used").get_to(figures.relations_used);
    json.at("relations_skipped").get_to(figures.relations_skipped);
    json.at("scans").get_to(figures.scans);
    json.at("duration_s").get_to(figures.duration_s);
    json.at("loops_accepted").get_to(figures.loops_accepted);
    json.at("loops_judged").get_to(figures.loops_judged);
    json.at("loops_false").get_to(figures.loops_false);
    const Json& recall = json.at("loop_recall");
    if (!recall.is_null()) figures.loop_recall = recall.get<double>();
    json.at("wall_s").get_to(figures.wall_s);
    json.at("cpu_s").get_to(figures.cpu_s);
    json.at("peak_memory_mib").get_to(figures.peak_memory_mib);
    return figures;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace psi_slam
