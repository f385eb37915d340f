// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_run.h"

#include <nlohmann/json.hpp>

#include "common/benchmark_logs.h"
#include "evaluation/loop_judgement.h"
#include "exports/mapped_trajectory.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/user_error.h"
#include "session/settings.h"

namespace psi_slam {

using Json = nlohmann::ordered_json;

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

FreiburgFigures map_and_evaluate(const FreiburgRun& run) {
  const std::vector<Relation> relations = read_relations(run.relations);
  MappingSession session(run.log, settings_of(run));
  while (session.step()) {
  }
  if (session.broken_off()) throw UserError(*session.broken_off());
  session.finish();

  const MappingResult& result = session.result();
  FreiburgFigures figures;
  static_cast<RunFigures&>(figures) = evaluate_path(trajectory_of(result.frames), relations);
  figures.loops_accepted = loops_accepted(result);
  const LoopJudgement judgement = judge_loops(result, relations);
  figures.loops_judged = judgement.judged.size();
  figures.loops_false = judgement.false_ones.size();
  figures.loop_recall = judgement.recall();
  return figures;
}

std::string figures_json(const FreiburgFigures& figures) {
  Json json = run_figures_json(figures);
  FreiburgFigures::visit_loops(figures, [&json](const char* key, const auto& value) { json[key] = value; });
  json["loop_recall"] = figures.loop_recall ? Json(*figures.loop_recall) : Json(nullptr);
  return json.dump();
}

std::optional<FreiburgFigures> read_figures(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    FreiburgFigures figures;
    static_cast<RunFigures&>(figures) = read_run_figures(json);
    FreiburgFigures::visit_loops(figures,
                                 [&json](const char* key, auto& value) { json.at(key).get_to(value); });
    const Json& recall = json.at("loop_recall");
    if (!recall.is_null()) figures.loop_recall = recall.get<double>();
    return figures;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace psi_slam
