// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/run_summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/mapped_trajectory.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Json = nlohmann::ordered_json;

/// Adds times, duration and odometry of one run. Runs may overlap in time, and odometry jumps between them.
void add_run(const std::vector<Frame>& log, const FrameSpan& run, MappedLogFacts& facts) {
  TimeUs first_us = log[run.begin].time_us;
  TimeUs last_us = first_us;
  TimeUs previous_us = first_us;
  std::vector<TPose2D> odometry;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    const TimeUs time_us = log[i].time_us;
    first_us = std::min(first_us, time_us);
    last_us = std::max(last_us, time_us);
    facts.stamps_back += time_us < previous_us ? 1 : 0;
    previous_us = time_us;
    odometry.push_back(log[i].odom_T_robot);
  }
  facts.first_time_us = std::min(facts.first_time_us, first_us);
  facts.last_time_us = std::max(facts.last_time_us, last_us);
  facts.duration_s += seconds(last_us - first_us);
  facts.odometry_length_m += path_length_m(odometry);
}

MappedLogFacts log_facts(const MappingResult& result) {
  MappedLogFacts facts;
  facts.scans = result.log.size();
  if (result.log.empty()) return facts;
  const LaserScan& first = result.log.front().scan;
  facts.beams = first.ranges_m.size();
  if (first.bearings_rad && !first.bearings_rad->empty()) {
    facts.first_bearing_rad = static_cast<double>(first.bearings_rad->front());
    facts.last_bearing_rad = static_cast<double>(first.bearings_rad->back());
  }
  facts.max_range_m = static_cast<double>(first.max_range_m);
  facts.robot_T_laser = first.robot_T_laser;
  facts.first_time_us = facts.last_time_us = result.log.front().time_us;
  std::size_t beams = 0;
  std::size_t returns = 0;
  for (const Frame& frame : result.log) {
    facts.companion_scans += frame.companions.size();
    for_each_scan(frame, {}, [&](const LaserScan& scan, const TPose2D&) {
      beams += scan.ranges_m.size();
      for (const float range_m : scan.ranges_m) returns += std::isfinite(range_m) ? 1 : 0;
    });
  }
  facts.returns = beams == 0 ? 0 : static_cast<double>(returns) / static_cast<double>(beams);
  for (const FrameSpan& run : runs_of(result)) add_run(result.log, run, facts);
  return facts;
}

LoopCounts loop_counts(const MappingResult& result) {
  LoopCounts counts;
  for (const auto& [kind, matcher] : result.loop_matchers) {
    counts.tried += matcher.effort.attempts;
    counts.found += matcher.effort.found;
  }
  std::map<LoopRejection::Reason, std::size_t> reasons;
  for (const LoopRecord& loop : result.loops) {
    counts.by_hand += loop.by_hand ? 1 : 0;
    if (found_nothing(loop)) continue;
    if (loop.state == LoopState::kAccepted) {
      ++counts.accepted;
      counts.accepted_in_final_search += loop.in_final_search ? 1 : 0;
      continue;
    }
    ++counts.rejected;
    if (loop.rejection) ++reasons[loop.rejection->reason];
  }
  for (const auto& [reason, count] : reasons) counts.reasons.push_back({reason, count});
  std::stable_sort(counts.reasons.begin(), counts.reasons.end(),
                   [](const ReasonCount& a, const ReasonCount& b) { return a.count > b.count; });
  return counts;
}

MapExtent map_extent(const mrpt::maps::COccupancyGridMap2D& grid, double asked_resolution_m) {
  const SeenCells seen = seen_cells(grid);
  const auto cell_m = static_cast<double>(grid.getResolution());
  return {seen_extent(grid, seen), cell_m, asked_resolution_m,
          static_cast<double>(seen.free) * cell_m * cell_m};
}

/// Rounds a value for JSON to `decimals` decimals. Null if the value is not finite.
Json number(double value, int decimals = 6) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = portable::pow(10.0, decimals);
  const double rounded = std::round(value * scale) / scale;
  return std::isfinite(rounded) ? rounded : value;
}

Json log_json(const MappedLogFacts& log, const std::string& name) {
  const TPose2D& mount = log.robot_T_laser;
  return {{"name", name},
          {"scans", log.scans},
          {"beams", log.beams},
          {"first_bearing_rad", number(log.first_bearing_rad)},
          {"last_bearing_rad", number(log.last_bearing_rad)},
          {"max_range_m", number(log.max_range_m, 3)},
          {"robot_T_laser", {number(mount.x), number(mount.y), number(mount.phi)}},
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
  return {{"resolution_m", number(map.resolution_m)},
          {"asked_resolution_m", number(map.asked_resolution_m)},
          {"x_min_m", number(map.x_min_m, 3)},
          {"y_min_m", number(map.y_min_m, 3)},
          {"x_max_m", number(map.x_max_m, 3)},
          {"y_max_m", number(map.y_max_m, 3)},
          {"free_m2", number(map.free_m2, 2)},
          {"frame",
           {{"x_m", number(map.map_T_start.x)},
            {"y_m", number(map.map_T_start.y)},
            {"yaw_deg", number(mrpt::RAD2DEG(map.map_T_start.phi), 9)}}}};
}

Json loop_counts_json(const LoopCounts& loops) {
  Json reasons = Json::array();
  for (const ReasonCount& reason : loops.reasons)
    reasons.push_back({{"reason", text_of(reason.reason)}, {"count", reason.count}});
  return {{"tried", loops.tried},       {"found", loops.found},
          {"accepted", loops.accepted}, {"accepted_in_last_pass", loops.accepted_in_final_search},
          {"rejected", loops.rejected}, {"by_hand", loops.by_hand},
          {"reasons", reasons}};
}

Json cost_json(const SearchCost& cost, std::size_t accepted) {
  return {{"attempts", cost.attempts},
          {"found", cost.found},
          {"accepted", accepted},
          {"evaluations", cost.evaluations},
          {"milliseconds", number(cost.milliseconds, 3)}};
}

/// The searches that a matcher ran, without kinds of searches that it did not run.
Json searches_json(const LoopMatcherRecord& matcher) {
  Json list = Json::array();
  for (const SearchKind search : kSearchKinds) {
    const SearchCost& cost = matcher.effort.of(search);
    if (cost.attempts == 0) continue;
    Json& entry = list.emplace_back(Json{{"search", name(search)}});
    entry.update(cost_json(cost, matcher.accepted_by_search[static_cast<std::size_t>(search)]));
  }
  return list;
}

Json loop_matchers_json(const std::map<MatcherKind, LoopMatcherRecord>& matchers) {
  Json list = Json::array();
  for (const auto& [kind, matcher] : matchers) {
    Json entry = {{"matcher", name(kind)}};
    entry.update(cost_json(matcher.effort, matcher.accepted));
    entry["last_pass"] = cost_json(matcher.final_search_effort, matcher.accepted_in_final_search);
    entry["searches"] = searches_json(matcher);
    list.push_back(std::move(entry));
  }
  return list;
}

Json unmatched_json(const UnmatchedScans& unmatched) {
  Json stretches = Json::array();
  for (const UnmatchedStretch& stretch : unmatched.stretches)
    stretches.push_back({{"first_scan", stretch.first_frame},
                         {"last_scan", stretch.last_frame},
                         {"first_time_s", format_seconds(stretch.first_time_us)},
                         {"last_time_s", format_seconds(stretch.last_time_us)},
                         {"odometry_length_m", number(stretch.predicted_length_m, 3)}});
  return {{"count", unmatched.count}, {"stretches", std::move(stretches)}};
}

Json interruptions_json(const std::vector<Interruption>& interruptions) {
  Json list = Json::array();
  for (const Interruption& interruption : interruptions)
    list.push_back(
        {{"first_scan", interruption.frame},
         {"found_scan", interruption.found_frame ? Json(*interruption.found_frame) : Json(nullptr)}});
  return list;
}

Json suspect_json(const HotSpot& spot) {
  const Suspect& suspect = spot.suspect;
  Json json = {{"text", text_of(suspect)},        {"first_scan", suspect.first_frame},
               {"last_scan", suspect.last_frame}, {"x_m", number(suspect.at.x, 3)},
               {"y_m", number(suspect.at.y, 3)},  {"places", spot.places_of_suspect}};
  if (suspect.kind == Suspect::Kind::kLoop) {
    json["loop"] = suspect.loop;
    json["local_map"] = suspect.local_map;
  }
  return json;
}

Json unchecked_json(const UncheckedStretch& stretch) {
  return {{"first_scan", stretch.first_frame},
          {"last_scan", stretch.last_frame},
          {"length_m", number(stretch.length_m, 3)},
          {"first_x_m", number(stretch.first_at.x, 3)},
          {"first_y_m", number(stretch.first_at.y, 3)},
          {"last_x_m", number(stretch.last_at.x, 3)},
          {"last_y_m", number(stretch.last_at.y, 3)},
          {"sigma_m", stretch.sigma_m ? number(*stretch.sigma_m, 3) : Json(nullptr)}};
}

Json open_json(const OpenStretch& stretch) {
  return {{"first_scan", stretch.first_frame},       {"last_scan", stretch.last_frame},
          {"length_m", number(stretch.length_m, 3)}, {"x_m", number(stretch.at.x, 3)},
          {"y_m", number(stretch.at.y, 3)},          {"has_odometry", stretch.has_odometry}};
}

Json verdict_json(const MapVerdict& verdict) {
  Json spots = Json::array();
  for (const HotSpot& spot : verdict.hot_spots)
    spots.push_back({{"kind", text_of(spot.kind)},
                     {"x_m", number(spot.at.x, 3)},
                     {"y_m", number(spot.at.y, 3)},
                     {"error_m", spot.error_m ? number(*spot.error_m, 3) : Json(nullptr)},
                     {"length_m", number(spot.length_m, 3)},
                     {"suspect", suspect_json(spot)},
                     {"advice", advice_text(spot)},
                     {"edit", spot.edit ? Json(edit_line(spot)) : Json(nullptr)},
                     {"moved_m", spot.effect ? number(spot.effect->moved_m, 3) : Json(nullptr)}});
  Json unchecked = Json::array();
  for (const UncheckedStretch& stretch : verdict.unchecked_stretches)
    unchecked.push_back(unchecked_json(stretch));
  Json changes = Json::array();
  for (const SceneChange& change : verdict.changes)
    changes.push_back({{"x_m", number(change.at.x, 3)},
                       {"y_m", number(change.at.y, 3)},
                       {"before_s", number(change.before_s, 3)},
                       {"after_s", number(change.after_s, 3)}});
  Json open = Json::array();
  for (const OpenStretch& stretch : verdict.open_stretches) open.push_back(open_json(stretch));
  return {{"state", text_of(verdict.state)},
          {"sentence", verdict_sentence(verdict)},
          {"error_m", number(verdict.error_m, 4)},
          {"predicted_m", number(verdict.predicted_m, 4)},
          {"doubt_m", number(verdict.doubt_m(), 4)},
          {"wall_thickness_m", number(verdict.wall_thickness_m, 4)},
          {"checked_share", number(verdict.checked_share, 4)},
          {"held_share", number(verdict.held_share, 4)},
          {"changes", changes},
          {"unchecked_stretches", std::move(unchecked)},
          {"open_stretches", std::move(open)},
          {"hot_spots", std::move(spots)},
          {"more_hot_spots", verdict.more_hot_spots}};
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

Json calibration_json(const std::vector<CalibratedOption>& estimates) {
  Json json = Json::array();
  for (const CalibratedOption& estimate : estimates) {
    json.push_back({{"log", estimate.log},
                    {"option", estimate.option},
                    {"value", number(estimate.value, 5)},
                    {"standard_deviation", number(estimate.deviation, 5)},
                    {"used", estimate.is_used}});
    if (!estimate.laser.empty()) json.back()["laser"] = estimate.laser;
    if (estimate.is_fault) json.back()["is_fault"] = true;
  }
  return json;
}

Json knowledge_json(const KnowledgeCounts& counts, const std::optional<PriorFit>& prior) {
  Json json = {{"used", counts.used}, {"left_out", counts.left_out}, {"prior_map", nullptr}};
  if (prior)
    json["prior_map"] = {
        {"accepted", prior->is_accepted}, {"places", prior->places}, {"fitting_places", prior->fitting}};
  return json;
}

Json runs_json(const std::vector<FrameSpan>& runs) {
  Json list = Json::array();
  for (const FrameSpan& run : runs)
    list.push_back({{"first_scan", run.begin}, {"scans", run.end - run.begin}});
  return list;
}

}  // namespace

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux states kibibytes
}

double path_length_m(const std::vector<TPose2D>& poses) {
  constexpr double kStep_m = 0.1;
  if (poses.empty()) return 0;
  double length = 0;
  TPose2D from = poses.front();
  const auto distance = [&](const TPose2D& to) { return distance_m(from, to); };
  for (const TPose2D& pose : poses) {
    if (distance(pose) < kStep_m) continue;
    length += distance(pose);
    from = pose;
  }
  return length + distance(poses.back());
}

RunSummary summarize_run(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                         const GridMapOptions& asked) {
  RunSummary summary;
  summary.log = log_facts(result);
  summary.runs = runs_of(result);
  std::size_t matched = 0;
  for (const FrameRecord& frame : result.frames) {
    summary.evaluations += frame.evaluations;
    summary.mean_response += frame.response;
    matched += frame.match == ScanMatch::kMatched ? 1 : 0;
  }
  for (const auto& [kind, matcher] : result.loop_matchers)
    summary.evaluations += matcher.final_search_effort.evaluations;
  if (matched > 0) summary.mean_response /= static_cast<double>(matched);
  summary.unmatched = unmatched_scans(result.frames, summary.runs);
  for (const auto& path : paths_of_runs(result)) summary.path_length_m += path_length_m(path);
  summary.nodes = result.graph.num_nodes();
  summary.edges = result.graph.num_enabled_constraints();
  summary.local_maps = result.local_maps.size();
  summary.loops = loop_counts(result);
  summary.map = map_extent(grid, asked.resolution_m);
  summary.wall_s = result.wall_s;
  if (result.wall_s > 0) summary.real_time_factor = summary.log.duration_s / result.wall_s;
  summary.peak_memory_mib = peak_memory_mib();
  summary.interrupted = result.interrupted;
  summary.final_search_cut_short = result.final_search_cut_short;
  summary.broken_off = result.broken_off;
  return summary;
}

std::optional<std::string> coarser_cells_text(const MapExtent& map) {
  if (map.resolution_m < 1.5 * map.asked_resolution_m)
    return std::nullopt;  // if map.max_cells enlarges cells, it doubles their size or more
  const auto metres = [](double value) { return shortest_text(static_cast<float>(value)) + " m"; };
  return "map.max_cells limits the map to cells of " + metres(map.resolution_m) + " instead of " +
         metres(map.asked_resolution_m);
}

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
               {"unmatched_scans", unmatched_json(summary.unmatched)},
               {"interruptions", interruptions_json(result.interruptions)},
               {"knowledge", knowledge_json(result.knowledge, summary.prior)},
               {"verdict", summary.verdict ? verdict_json(*summary.verdict) : Json(nullptr)},
               {"evaluations", summary.evaluations},
               {"map", map_json(summary.map)},
               {"wall_s", number(summary.wall_s)},
               {"real_time_factor", number(summary.real_time_factor, 3)},
               {"peak_memory_mib", number(summary.peak_memory_mib, 1)},
               {"stages", stages_json(result.stages)},
               {"loop_counts", loop_counts_json(summary.loops)},
               {"loop_matchers", loop_matchers_json(result.loop_matchers)},
               {"settings", info.settings}};
  if (summary.runs.size() > 1) json["drives"] = runs_json(summary.runs);
  if (!info.calibration.empty()) json["calibration"] = calibration_json(info.calibration);
  // Names and warnings may hold bytes of the user's files that are not UTF-8.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace psi_slam
