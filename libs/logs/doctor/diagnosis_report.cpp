// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/input_doctor.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/core/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/number_text.h"

namespace psi_slam {
namespace {

using mrpt::RAD2DEG;
using Json = nlohmann::ordered_json;

std::string_view name_of(HeadingRelation relation) {
  constexpr std::array<std::string_view, 7> kNames{"unknown",          "agrees", "opposite", "degrees",
                                                   "opposite degrees", "none",   "unrelated"};
  return kNames.at(static_cast<std::size_t>(relation));
}

Json to_json(const mrpt::math::TPose2D& pose) {
  return {{"x_m", pose.x}, {"y_m", pose.y}, {"yaw_rad", pose.phi}};
}

Json facts_json(const LogFacts& facts, const MaxRange& max_range) {
  const TimeFacts& time = facts.time;
  const RangeFacts& ranges = facts.ranges;
  return {{"broken_off", facts.broken_off},
          {"format", facts.format},
          {"laser", facts.contents.laser},
          {"scans", facts.scans},
          {"beams", facts.beams},
          {"first_bearing_rad", facts.first_bearing_rad},
          {"last_bearing_rad", facts.last_bearing_rad},
          {"scans_of_other_shape", facts.scans_of_other_shape},
          {"robot_T_laser", to_json(facts.robot_T_laser)},
          {"time",
           {{"first_s", format_seconds(time.first_us)},
            {"last_s", format_seconds(time.last_us)},
            {"duration_s", time.duration_s},
            {"median_period_s", time.median_period_s},
            {"gaps", time.gaps},
            {"largest_gap_s", time.largest_gap_s},
            {"backward_steps", time.backward_steps},
            {"largest_backward_step_s", time.largest_backward_step_s},
            {"repeated_stamps", time.repeated_stamps},
            {"repeated_scans", time.repeated_scans}}},
          {"odometry",
           {{"scans_without", facts.scans_without_odometry},
            {"path_length_m", facts.odometry.path_length_m},
            {"turned_rad", facts.odometry.turned_rad},
            {"largest_step_m", facts.odometry.largest_step_m},
            {"largest_turn_rad", facts.odometry.largest_turn_rad}}},
          {"ranges",
           {{"max_range_m", ranges.max_range_m},
            {"no_return_share", 1 - ranges.return_share()},
            {"empty_scans", ranges.empty_scans},
            {"median_return_m", ranges.median_return_m},
            {"largest_reading_m", ranges.largest_reading_m},
            {"no_return_code_m", max_range.code_m}}},
          {"scans_with_two_poses", facts.contents.scans_with_two_poses},
          {"messages", facts.contents.messages},
          {"skipped_lines", facts.contents.skipped.count},
          {"scans_of_other_lasers", facts.contents.other_lasers}};
}

Json own_body_json(const std::vector<BodySector>& sectors) {
  Json json = Json::array();
  for (const BodySector& sector : sectors) {
    json.push_back({{"beams", sector.beams},
                    {"from_rad", sector.from_rad},
                    {"to_rad", sector.to_rad},
                    {"nearest_m", sector.nearest_m},
                    {"farthest_m", sector.farthest_m}});
  }
  return json;
}

Json beam_angles_json(const BeamAngleStudy& study) {
  Json fits = Json::array();
  for (const BeamAngleFit& fit : study.fits) {
    Json entry{{"angles", psi_slam::name_of(fit.angles)},
               {"mean_distance_m", fit.mean_distance_m},
               {"worse_by_m", fit.worse_by_m},
               {"significance", fit.significance},
               {"ruled_out", fit.ruled_out_by_walls || fit.ruled_out_by_turns}};
    if (study.full_turns > 0) entry["full_turn_error_rad"] = fit.full_turn_error_rad;
    if (study.knows_heading) entry["laser_heading_rad"] = fit.laser_heading_rad;
    fits.push_back(entry);
  }
  Json json{{"pairs", study.pairs}, {"full_turns", study.full_turns}, {"fits", fits}};
  if (!study.fits.empty()) json["best"] = psi_slam::name_of(study.best);
  return json;
}

/// The orders of beams that a study compares, with their names.
std::array<std::pair<const char*, const SweepFit*>, 3> named_fits(const SweepDirectionStudy& study) {
  return {{{"forward", &study.forward}, {"backward", &study.backward}, {"at_once", &study.at_once}}};
}

Json sweep_direction_json(const SweepDirectionStudy& study) {
  Json json{{"stated_sweep_time_s", study.stated_sweep_time_s},
            {"pairs", study.pairs},
            {"mean_bend_rad", study.mean_bend_rad}};
  if (study.pairs == 0) return json;
  for (const auto& [name, fit] : named_fits(study)) {
    json[name] = {{"mean_distance_m", fit->mean_distance_m},
                  {"worse_by_m", fit->worse_by_m},
                  {"significance", fit->significance},
                  {"ruled_out", fit->ruled_out}};
  }
  return json;
}

}  // namespace

std::vector<std::string> describe_facts(const LogDiagnosis& diagnosis) {
  const LogFacts& facts = diagnosis.facts;
  const TimeFacts& time = facts.time;
  const RangeFacts& ranges = facts.ranges;
  std::vector<std::string> lines;
  lines.push_back(mrpt::format("%s: %s, %zu scans%s%s of %zu beams from %.2f to %.2f degrees",
                               diagnosis.path.filename().c_str(), facts.format.c_str(), facts.scans,
                               facts.contents.laser.empty() ? "" : " by ", facts.contents.laser.c_str(),
                               facts.beams, RAD2DEG(facts.first_bearing_rad),
                               RAD2DEG(facts.last_bearing_rad)));
  lines.push_back(mrpt::format("time: %.1f s from %s, a scan every %.3f s", time.duration_s,
                               format_seconds(time.first_us).c_str(), time.median_period_s));
  lines.push_back(facts.scans_without_odometry == facts.scans
                      ? "odometry: none"
                      : mrpt::format("odometry: path of %.1f m, %.0f degrees of turns",
                                     facts.odometry.path_length_m, RAD2DEG(facts.odometry.turned_rad)));
  lines.push_back(
      mrpt::format("ranges: maximum %.2f m, median %.2f m, %.1f %% of the readings are no returns",
                   static_cast<double>(ranges.max_range_m), static_cast<double>(ranges.median_return_m),
                   100 * (1 - ranges.return_share())));
  lines.push_back(mrpt::format("laser on the robot: x %.3f m, y %.3f m, yaw %.2f degrees",
                               facts.robot_T_laser.x, facts.robot_T_laser.y,
                               RAD2DEG(facts.robot_T_laser.phi)));
  for (const auto& [label, scans] : facts.contents.other_lasers)
    lines.push_back(mrpt::format("another laser: %zu scans by \"%s\"", scans, label.c_str()));
  return lines;
}

std::vector<std::string> describe_beam_angles(const BeamAngleStudy& study) {
  std::vector<std::string> lines;
  if (study.fits.empty()) return lines;
  lines.push_back(
      mrpt::format("beam angles, by %zu pairs of scans and %zu full turns:", study.pairs, study.full_turns));
  for (const BeamAngleFit& fit : study.fits) {
    std::string line = mrpt::format("  %c %-22.*s points to walls %.2f mm (%+.2f mm, %.1f standard errors)",
                                    fit.angles == study.best ? '*' : ' ',
                                    static_cast<int>(psi_slam::name_of(fit.angles).size()),
                                    psi_slam::name_of(fit.angles).data(), 1000 * fit.mean_distance_m,
                                    1000 * fit.worse_by_m, fit.significance);
    if (study.full_turns > 0)
      line += mrpt::format(", full-turn error %.2f degrees", RAD2DEG(fit.full_turn_error_rad));
    if (study.knows_heading)
      line += mrpt::format(", laser heading off by %.2f degrees", RAD2DEG(fit.laser_heading_rad));
    if (fit.ruled_out_by_walls || fit.ruled_out_by_turns) line += ": ruled out";
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> describe_sweep_direction(const SweepDirectionStudy& study) {
  std::vector<std::string> lines;
  if (study.pairs == 0) return lines;
  lines.push_back(mrpt::format(
      "order of the beams in a sweep of %.3f s, by %zu pairs of scans that turns bend differently "
      "(by %.1f degrees on average):",
      std::abs(study.stated_sweep_time_s), study.pairs, RAD2DEG(study.mean_bend_rad)));
  for (const auto& [name, fit] : named_fits(study)) {
    lines.push_back(mrpt::format("  %c %-8s  points to walls %.2f mm (%+.2f mm, %.1f standard errors)%s",
                                 fit->worse_by_m == 0 ? '*' : ' ', name, 1000 * fit->mean_distance_m,
                                 1000 * fit->worse_by_m, fit->significance,
                                 fit->ruled_out ? ": ruled out" : ""));
  }
  return lines;
}

std::string refusal_of(const LogDiagnosis& diagnosis) {
  if (diagnosis.scans_without_returns > 0)
    return no_returns_text(diagnosis.path.string(), diagnosis.scans_without_returns);
  return diagnosis.facts.broken_off;
}

std::string verdict_of(const LogDiagnosis& diagnosis) {
  if (diagnosis.scans_without_returns > 0) return "cannot be mapped";
  const auto warnings = static_cast<std::size_t>(
      std::count_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                    [](const Finding& finding) { return finding.severity == Severity::kWarning; }));
  return warnings == 0 ? "ready to map" : "maps with " + counted(warnings, "warning");
}

std::vector<std::string> describe(const LogDiagnosis& diagnosis) {
  std::vector<std::string> lines = describe_facts(diagnosis);
  for (std::string& line : describe_beam_angles(diagnosis.beam_angles)) lines.push_back(std::move(line));
  for (std::string& line : describe_sweep_direction(diagnosis.sweep_direction))
    lines.push_back(std::move(line));
  for (const Finding& finding : diagnosis.findings) {
    lines.push_back(std::string(finding.severity == Severity::kWarning ? "warning: " : "note: ") +
                    finding.sentence);
    if (!finding.remedy.empty()) lines.push_back("  remedy: " + finding.remedy);
  }
  lines.push_back("verdict: " + verdict_of(diagnosis));
  return lines;
}

Json to_json(const LogDiagnosis& diagnosis) {
  Json json{{"log", diagnosis.path.string()}, {"facts", facts_json(diagnosis.facts, diagnosis.max_range)}};
  json["own_body"] = own_body_json(diagnosis.own_body);
  const OdometryAgreement& odometry = diagnosis.odometry;
  json["odometry_check"] = {{"sound", diagnosis.odometry_is_sound},
                            {"tracks", odometry.tracks},
                            {"length_ratio", odometry.length_ratio},
                            {"heading", name_of(odometry.heading)},
                            {"lost_reversals", diagnosis.reversals.pairs.size()},
                            {"jumps", diagnosis.jumps.pairs.size()},
                            {"revisits", diagnosis.revisits.revisits},
                            {"revisits_agreeing", diagnosis.revisits.agreeing}};
  if (diagnosis.mount) {
    json["laser_mount_estimate"] = {{"robot_T_laser", to_json(diagnosis.mount->robot_T_laser)},
                                    {"deviation_m", diagnosis.mount->deviation_m},
                                    {"deviation_rad", diagnosis.mount->deviation_rad},
                                    {"odometry_scale", diagnosis.mount->odometry_scale},
                                    {"odometry_scale_deviation", diagnosis.mount->scale_deviation}};
  }
  if (diagnosis.delay) {
    json["scan_delay_estimate"] = {{"delay_s", diagnosis.delay->delay_s},
                                   {"deviation_s", diagnosis.delay->deviation_s},
                                   {"turns", diagnosis.delay->turns}};
  }
  json["beam_angles"] = beam_angles_json(diagnosis.beam_angles);
  json["sweep_direction"] = sweep_direction_json(diagnosis.sweep_direction);
  json["verdict"] = verdict_of(diagnosis);
  json["findings"] = Json::array();
  for (const Finding& finding : diagnosis.findings) {
    json["findings"].push_back({{"code", finding.code},
                                {"severity", finding.severity == Severity::kWarning ? "warning" : "note"},
                                {"sentence", finding.sentence},
                                {"remedy", finding.remedy}});
  }
  return json;
}

}  // namespace psi_slam
