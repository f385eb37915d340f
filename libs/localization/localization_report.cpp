// SPDX-License-Identifier: BSD-3-Clause
#include "localization/localization_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/atomic_folder.h"
#include "base/degrees.h"
#include "base/median.h"
#include "base/number_text.h"
#include "map/trajectory/trajectory_file.h"

namespace psi_slam {
namespace {

using State = LocalizationStep::State;

std::string percent(std::size_t part, std::size_t whole) {
  return fixed_text(whole == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::string times(int count) {
  return count == 1 ? "once" : std::to_string(count) + " times";
}

/// Returns the mean confidence of the scans at the end of the log; see LocalizationSummary.
double confidence_at_end(const std::vector<LocalizationStep>& steps) {
  double sum = 0;
  std::size_t count = 0;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step, ++count) {
    const bool at_end = seconds(steps.back().time_us - step->time_us) <= LocalizationSummary::kEnd_s;
    if (!at_end && count >= LocalizationSummary::kEndScans) break;
    sum += step->confidence;
  }
  return count == 0 ? 0 : sum / static_cast<double>(count);
}

/// Returns a sentence on the state of the robot at the end of the log.
std::string end_text(const LocalizationSummary& summary) {
  if (!summary.tracked_at_end)
    return "Lost at the end, since " + fixed_text(summary.lost_after_s.value_or(0), 1) +
           " s: " + summary.why_not;
  const std::string confidence = fixed_text(summary.confidence, 2);
  if (summary.localized_at_end()) return "Localized at the end, with a confidence of " + confidence;
  return "Not localized at the end: tracked, but with a confidence of only " + confidence + ", less than " +
         fixed_text(LocalizationSummary::kLeastConfidence, 2);
}

}  // namespace

LocalizationSummary summarize(const std::vector<LocalizationStep>& steps) {
  LocalizationSummary summary;
  summary.scans = steps.size();
  std::vector<double> responses;
  State before = State::kLost;
  for (const LocalizationStep& step : steps) {
    summary.travelled_m += step.moved_m;
    summary.duration_s = seconds(step.time_us - steps.front().time_us);
    if (step.search) {
      ++summary.searches;
      summary.why_not = step.search->objection;
      summary.ambiguous = step.search->ambiguous;
      summary.best_response = std::max(summary.best_response, step.search->response);
    }
    const bool tracks = step.state == State::kTracking;
    summary.tracked_at_end = tracks;
    if (tracks) {
      ++summary.tracked;
      summary.lost_after_s = summary.duration_s;
    }
    if (tracks && before == State::kLost && step.search) {
      ++summary.times_found;
      if (!summary.found_after_s) summary.ambiguity = step.search->ambiguity;
    }
    if (!tracks && before == State::kTracking) ++summary.times_lost;
    if (step.fits) responses.push_back(step.response);
    if (step.fits && !summary.found_after_s) {
      summary.found_after_s = summary.duration_s;
      summary.found_after_m = summary.travelled_m;
      summary.map_T_found = step.map_T_robot;
    }
    before = step.state;
  }
  summary.fitting = responses.size();
  summary.median_response = median(std::move(responses));
  summary.confidence = confidence_at_end(steps);
  if (summary.tracked_at_end) summary.lost_after_s.reset();
  if (summary.tracked_at_end && summary.found()) {
    summary.why_not.clear();
    summary.ambiguous = false;
  } else if (summary.why_not.empty()) {
    summary.why_not = summary.searches == 0 ? "the whole map was never searched"
                                            : "too few of the places found agree with each other";
  }
  return summary;
}

std::string localization_text(const LocalizationSummary& summary) {
  const std::string way = std::to_string(summary.scans) + " scans over " + fixed_text(summary.duration_s, 1) +
                          " s and " + fixed_text(summary.travelled_m, 1) + " m";
  if (!summary.found())
    return "Not found in " + way + ": " + summary.why_not + ".\nThe whole map was searched " +
           times(summary.searches) + "; the best response was " + fixed_text(summary.best_response, 2) +
           ".\n";
  const auto& [x_m, y_m, yaw_rad] = summary.map_T_found;
  std::string text = "Found after " + fixed_text(*summary.found_after_m, 1) + " m and " +
                     fixed_text(*summary.found_after_s, 1) + " s at x " + fixed_text(x_m, 2) + " m, y " +
                     fixed_text(y_m, 2) + " m, yaw " + fixed_text(yaw_rad / radians_from_degrees(1), 1) +
                     " degrees";
  if (summary.ambiguity == 0.0)
    text += "; no other place came near";
  else if (summary.ambiguity)
    text += "; the response of the next best place is " + fixed_text(*summary.ambiguity, 2) + " of that";
  text += ".\n" + end_text(summary) + ".\nOf " + way + ", " + percent(summary.tracked, summary.scans) +
          " of the scans were tracked and " + percent(summary.fitting, summary.scans) +
          " fit the map, with a median response of " + fixed_text(summary.median_response, 2) + ".\n";
  if (summary.times_lost > 0)
    text += "The robot was lost " + times(summary.times_lost) + " and found by searching the whole map " +
            times(summary.times_found) + ".\n";
  return text;
}

std::string localization_json(const LocalizationSummary& summary) {
  const auto number = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json found_at;  // x and y in metres, theta in radians
  if (summary.found()) found_at = {summary.map_T_found.x, summary.map_T_found.y, summary.map_T_found.phi};
  const nlohmann::ordered_json json = {{"found", summary.found()},
                                       {"localized_at_end", summary.localized_at_end()},
                                       {"confidence", summary.confidence},
                                       {"interrupted", summary.interrupted},
                                       {"ambiguous", summary.ambiguous},
                                       {"why_not", summary.why_not},
                                       {"scans", summary.scans},
                                       {"tracked", summary.tracked},
                                       {"tracked_share", summary.tracked_share()},
                                       {"fitting", summary.fitting},
                                       {"duration_s", summary.duration_s},
                                       {"travelled_m", summary.travelled_m},
                                       {"found_after_m", number(summary.found_after_m)},
                                       {"found_after_s", number(summary.found_after_s)},
                                       {"found_at", found_at},
                                       {"lost_after_s", number(summary.lost_after_s)},
                                       {"ambiguity", number(summary.ambiguity)},
                                       {"searches", summary.searches},
                                       {"times_found", summary.times_found},
                                       {"times_lost", summary.times_lost},
                                       {"best_search_response", summary.best_response},
                                       {"median_response", summary.median_response}};
  return json.dump(2) + '\n';
}

std::string localization_csv(const std::vector<LocalizationStep>& steps) {
  std::string text = "time_s,state,x_m,y_m,theta_rad,response,confidence,fits,ambiguity,note\n";
  for (const LocalizationStep& step : steps) {
    const bool tracks = step.state == State::kTracking;
    text += format_seconds(step.time_us) + (tracks ? ",tracking," : ",lost,");
    if (tracks)
      for (const double value : {step.map_T_robot.x, step.map_T_robot.y, step.map_T_robot.phi})
        text += fixed_text(value, 6) + ',';
    else
      text += ",,,";
    const bool found_something = step.search && step.search->found;
    const double response = found_something && !tracks ? step.search->response : step.response;
    text += fixed_text(response, 4) + ',' + fixed_text(step.confidence, 4) + (step.fits ? ",1," : ",0,");
    if (found_something) text += fixed_text(step.search->ambiguity, 4);
    text += ',';
    if (step.search && !step.search->objection.empty()) text += '"' + step.search->objection + '"';
    text += '\n';
  }
  return text;
}

void write_localization(const std::vector<LocalizationStep>& steps, const std::filesystem::path& folder) {
  Trajectory trajectory;
  for (const LocalizationStep& step : steps)
    if (step.state == State::kTracking) trajectory.push_back({step.time_us, step.map_T_robot});
  write_files_atomically(folder, [&](const std::filesystem::path& temporary) {
    write_text_atomically(temporary / "localization.csv", localization_csv(steps));
    write_tum(temporary / "trajectory.tum", trajectory);
  });
}

}  // namespace psi_slam
