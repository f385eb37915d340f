// SPDX-License-Identifier: BSD-3-Clause
#include "exports/summary_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

/// Rounded to what is worth reading: JSON with seventeen digits a number is for nobody.
Json number(double value, int decimals = 6) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10.0, decimals);
  const double rounded = std::round(value * scale) / scale;
  return std::isfinite(rounded) ? rounded : value;
}

Json pose_json(const mrpt::math::TPose2D& pose) {
  return {number(pose.x), number(pose.y), number(pose.phi)};
}

Json log_json(const MappedLogFacts& log, const std::string& name) {
  return {{"name", name},
          {"scans", log.scans},
          {"beams", log.beams},
          {"first_bearing_rad", number(log.first_bearing_rad)},
          {"last_bearing_rad", number(log.last_bearing_rad)},
          {"max_range_m", number(log.max_range_m, 3)},
          {"robot_T_laser", pose_json(log.robot_T_laser)},
          {"returns", number(log.returns, 4)},
          {"companion_scans", log.companion_scans},
          {"spare_scans", log.spare_scans},
          {"first_time_s", format_seconds(log.first_time_us)},
          {"last_time_s", format_seconds(log.last_time_us)},
          {"duration_s", number(log.duration_s)},
          {"stamps_back", log.stamps_back},
          {"odometry_length_m", number(log.odometry_length_m, 3)}};
}

Json map_json(const MapExtent& map) {
  return {{"resolution_m", number(map.resolution_m)}, {"asked_resolution_m", number(map.asked_resolution_m)},
          {"x_min_m", number(map.x_min_m, 3)},        {"y_min_m", number(map.y_min_m, 3)},
          {"x_max_m", number(map.x_max_m, 3)},        {"y_max_m", number(map.y_max_m, 3)},
          {"free_m2", number(map.free_m2, 2)}};
}

Json loop_counts_json(const LoopCounts& loops) {
  Json reasons = Json::array();
  for (const ReasonCount& reason : loops.reasons)
    reasons.push_back({{"reason", text_of(reason.reason)}, {"count", reason.count}});
  return {{"tried", loops.tried},       {"found", loops.found},
          {"accepted", loops.accepted}, {"accepted_in_last_pass", loops.accepted_in_final_search},
          {"refused", loops.refused},   {"switched_off", loops.switched_off},
          {"by_hand", loops.by_hand},   {"reasons", reasons}};
}

Json effort_json(const LoopEffort& effort, std::size_t accepted) {
  return {{"attempts", effort.attempts},
          {"found", effort.found},
          {"accepted", accepted},
          {"evaluations", effort.evaluations},
          {"milliseconds", number(effort.milliseconds, 3)}};
}

/// Of each matcher over the whole run, and of that what the last pass took.
Json loop_matchers_json(const std::map<MatcherKind, LoopMatcherRecord>& matchers) {
  Json list = Json::array();
  for (const auto& [kind, matcher] : matchers) {
    Json entry = {{"matcher", name(kind)}};
    entry.update(effort_json(matcher.effort, matcher.accepted));
    entry["last_pass"] = effort_json(matcher.final_search_effort, matcher.accepted_in_final_search);
    list.push_back(std::move(entry));
  }
  return list;
}

Json stages_json(const std::vector<StageTiming>& stages) {
  Json list = Json::array();
  for (const StageTiming& stage : stages)
    list.push_back({{"name", stage.name},
                    {"calls", stage.calls},
                    {"mean_ms", number(stage.mean_ms)},
                    {"std_ms", number(stage.std_ms)},
                    {"min_ms", number(stage.min_ms)},
                    {"max_ms", number(stage.max_ms)},
                    {"total_s", number(stage.total_s)}});
  return list;
}

Json drives_json(const std::vector<FrameSpan>& runs) {
  Json list = Json::array();
  for (const FrameSpan& drive : runs)
    list.push_back({{"first_scan", drive.begin}, {"scans", drive.end - drive.begin}});
  return list;
}

}  // namespace

std::string summary_json(const MappingResult& result, const RunInfo& info, const RunSummary& summary) {
  Json json = {{"schema", "psi-slam-summary"},
               {"schema_version", kSummarySchemaVersion},
               {"program_version", info.program_version},
               {"interrupted", summary.interrupted},
               {"warnings", info.warnings},
               {"last_pass_cut_short", summary.final_search_cut_short},
               {"broken_off", summary.broken_off ? Json(*summary.broken_off) : Json(nullptr)},
               {"log", log_json(summary.log, info.log_name)},
               {"path_length_m", number(summary.path_length_m, 3)},
               {"nodes", summary.nodes},
               {"edges", summary.edges},
               {"local_maps", summary.local_maps},
               {"mean_response", number(summary.mean_response, 4)},
               {"evaluations", summary.evaluations},
               {"map", map_json(summary.map)},
               {"wall_s", number(summary.wall_s)},
               {"real_time_factor", number(summary.real_time_factor, 3)},
               {"peak_memory_mib", number(summary.peak_memory_mib, 1)},
               {"stages", stages_json(result.stages)},
               {"loop_counts", loop_counts_json(summary.loops)},
               {"loop_matchers", loop_matchers_json(result.loop_matchers)},
               {"settings", info.settings}};
  if (summary.runs.size() > 1) json["drives"] = drives_json(summary.runs);
  // Names and reasons are whatever bytes the user's files had: what is no UTF-8 is replaced, not refused.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace psi_slam
