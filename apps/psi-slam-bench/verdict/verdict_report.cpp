// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "verdict/verdict_benchmark.h"

namespace psi_slam {
namespace {

using Rows = std::vector<VerdictRow>;

template <class Condition>
std::size_t count_of(const Rows& rows, const Condition& condition) {
  return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), condition));
}

std::size_t count_of_state(const Rows& rows, MapState state) {
  return count_of(rows, [&](const VerdictRow& row) { return row.state == state; });
}

bool is_located(const VerdictRow& row) {
  return is_fault_to_locate(row) && row.distance_m && *row.distance_m <= kLocated_m;
}

/// Text such as "17 of 20".
std::string share_text(std::size_t part, std::size_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole);
}

/// One group of maps in a row of the table.
struct Group {
  std::string name;
  Rows rows;
};

ReportTable table_of_groups(const std::vector<Group>& groups) {
  const auto state = [](const std::string& head, MapState which) {
    return ColumnOf<Group>{{head, head},
                           [=](const Group& group) { return cell(count_of_state(group.rows, which)); }};
  };
  return table_of<Group>(
      {column("maps", "name", &Group::name),
       {{"number", "number"}, [](const Group& group) { return cell(group.rows.size()); }},
       {{"true error [m]", "error_m"},
        [](const Group& group) {
          return cell(spread_over(group.rows, [](const VerdictRow& row) { return row.error_m; }).mean, 3);
        }},
       {{"doubt [m]", "doubt_m"},
        [](const Group& group) {
          return cell(spread_over(group.rows, [](const VerdictRow& row) { return row.doubt_m; }).mean, 3);
        }},
       state("good", MapState::kGood),
       state("unchecked", MapState::kUnchecked),
       state("check", MapState::kCheck),
       state("broken", MapState::kBroken),
       {{"fault found", "located"},
        [](const Group& group) {
          const std::size_t faults = count_of(group.rows, is_fault_to_locate);
          return faults == 0 ? empty_cell() : cell(share_text(count_of(group.rows, is_located), faults));
        }}},
      groups);
}

/// Rows of simulated buildings, or of logs.
Rows rows_of(const Rows& rows, bool of_logs) {
  Rows chosen;
  for (const VerdictRow& row : rows)
    if (row.log.empty() != of_logs) chosen.push_back(row);
  return chosen;
}

std::vector<Group> groups_by_error(const Rows& rows) {
  std::vector<Group> groups{{"mean error up to 0.05 m", {}}, {"0.05 m to 0.25 m", {}}, {"above 0.25 m", {}}};
  for (const VerdictRow& row : rows)
    groups[row.error_m <= kRightMap_m ? 0 : row.error_m <= kWrongMap_m ? 1 : 2].rows.push_back(row);
  return groups;
}

std::vector<Group> groups_by_fault(const Rows& rows) {
  std::vector<Group> groups;
  for (const MapFault fault : kMapFaults) {
    Group& group = groups.emplace_back(Group{name_of(fault), {}});
    for (const VerdictRow& row : rows)
      if (row.fault == fault) group.rows.push_back(row);
  }
  return groups;
}

/// One kind of maps in a row of the table of the main figures.
ReportTable table_of_figures(const Rows& rows) {
  std::vector<Group> groups{{"simulated buildings", rows_of(rows, false)}};
  if (Rows of_logs = rows_of(rows, true); !of_logs.empty()) {
    groups.push_back({"logs, error over the relations", of_logs});
    for (VerdictRow& row : of_logs) row.error_m = std::max(row.error_m, row.map_distance_m);
    groups.push_back({"logs, larger of both errors", of_logs});
    groups.push_back({"simulated buildings and logs, error over the relations", rows});
    Rows all = rows;
    for (VerdictRow& row : all) row.error_m = std::max(row.error_m, row.map_distance_m);
    groups.push_back({"simulated buildings and logs, larger of both errors", std::move(all)});
  }
  return table_of<Group>(
      {column("maps", "name", &Group::name),
       {{"number", "number"}, [](const Group& group) { return cell(group.rows.size()); }},
       {{"area under the ROC curve", "area"},
        [](const Group& group) { return cell(area_under_curve(group.rows), 4); }},
       {{"faults found", "located"},
        [](const Group& group) {
          return cell(share_text(count_of(group.rows, is_located), count_of(group.rows, is_fault_to_locate)));
        }},
       {{"wrong maps called good", "missed"},
        [](const Group& group) {
          const auto is_wrong = [](const VerdictRow& row) { return row.error_m > kWrongMap_m; };
          return cell(share_text(
              count_of(group.rows,
                       [&](const VerdictRow& row) { return is_wrong(row) && row.state == MapState::kGood; }),
              count_of(group.rows, is_wrong)));
        }},
       {{"right maps called broken", "false_alarms"},
        [](const Group& group) {
          const auto is_right = [](const VerdictRow& row) { return row.error_m <= kRightMap_m; };
          return cell(share_text(count_of(group.rows,
                                          [&](const VerdictRow& row) {
                                            return is_right(row) && row.state == MapState::kBroken;
                                          }),
                                 count_of(group.rows, is_right)));
        }}},
      groups);
}

/// The maps of the logs without a fault.
ReportTable table_of_logs(const Rows& rows) {
  Rows whole;
  for (const VerdictRow& row : rows)
    if (!row.log.empty() && row.fault == MapFault::kNone) whole.push_back(row);
  return table_of<VerdictRow>(
      {column("log", "log", &VerdictRow::log),
       column("true error [m]", "error_m", &VerdictRow::error_m, 3),
       {{"verdict", "state", true}, [](const VerdictRow& row) { return cell(text_of(row.state)); }},
       column("doubt [m]", "doubt_m", &VerdictRow::doubt_m, 3),
       column("hot spots", "hot_spots", &VerdictRow::hot_spots)},
      whole);
}

ReportTable table_of_maps(const Rows& rows) {
  return table_of<VerdictRow>(
      {column("log", "log", &VerdictRow::log),
       {{"fault", "fault", true}, [](const VerdictRow& row) { return cell(name_of(row.fault)); }},
       {{"seed", "seed"}, [](const VerdictRow& row) { return cell(static_cast<std::size_t>(row.seed)); }},
       column("error [m]", "error_m", &VerdictRow::error_m, 4),
       column("distance from the map [m]", "map_distance_m", &VerdictRow::map_distance_m, 4),
       {{"verdict", "state", true}, [](const VerdictRow& row) { return cell(text_of(row.state)); }},
       column("doubt [m]", "doubt_m", &VerdictRow::doubt_m, 4),
       column("hot spots", "hot_spots", &VerdictRow::hot_spots),
       {{"distance [m]", "distance_m"}, [](const VerdictRow& row) { return cell(row.distance_m, 2); }},
       column("time [ms]", "judge_ms", &VerdictRow::judge_ms, 1)},
      rows);
}

std::string markdown_of(const Rows& rows, const VerdictBenchmarkOptions& options,
                        const std::string& machine) {
  const Rows of_logs = rows_of(rows, true);
  std::string text =
      "# How far the verdict can be trusted\n\nThis page shows how well psi-slam judges its maps without "
      "ground truth. The maps have known errors: they are of simulated buildings, and of logs with true "
      "relations.\n\n" +
      measured_by(machine) + "; " + seeds_text(options.seeds) + " of the buildings with paths from " +
      fixed_text(options.path_m, 0) + " m on" +
      (of_logs.empty() ? "" : ", " + seeds_text(options.log_seeds) + " of the faults of the logs") + ", " +
      counted(rows.size(), "map") + ".\n\n";
  text +=
      "- true error of a simulated map: mean distance of the scans from the truth, after the best rigid "
      "alignment of both paths\n"
      "- true error of the map of a log: mean translational error over the relations of the log. Scans that "
      "were thinned out are put back by the map of the whole log\n"
      "- larger of both errors: most relations are shorter than 2 m and hide that parts of a map are "
      "displaced. So the "
      "second error of a map of a log is the mean distance of the scans from the map of the whole log, after "
      "the best rigid alignment\n"
      "- doubt: the figure that ranks the maps, in metres: the estimated mean error, plus the mean standard "
      "deviation of the positions that the pose graph predicts\n"
      "- false loop, nearby loop, loop group: one false loop, one true loop moved by 1 to 3 m, or five false "
      "loops that agree, with full weight and without the defence of the mapper; one of 60 true loops is "
      "kept\n"
      "- no loops: loop closing off, one of 2 to 5 scans, ranges up to 4 to 8 m, noisy odometry\n"
      "- slip: wheels slip by 0.3 to 0.8 m and 6 to 14 degrees while the laser is blind for 2.5 m; loop "
      "closing off\n"
      "- carried: the robot is moved by 8 to 18 m while it is off\n"
      "- thinned: one of 4 to 11 scans, ranges up to 8 m, noisy odometry\n"
      "- paused: the robot is off for a minute, and odometry begins again at zero\n"
      "- area under the ROC curve: between right maps, up to 0.05 m, and wrong maps, above 0.25 m\n"
      "- fault found: of the maps with one fault and an error above 0.05 m, those where the suspect of the "
      "worst place is at most 2 m from the fault. The suspect of a false loop must be a loop\n\n";
  text += "Processor time of a verdict: " +
          fixed_text(spread_over(rows, [](const VerdictRow& row) { return row.judge_ms; }).mean, 1) +
          " ms on average.\n\n" + table_of_figures(rows).markdown() + "\n## Simulated buildings\n\n" +
          table_of_groups(groups_by_error(rows_of(rows, false))).markdown() + '\n' +
          table_of_groups(groups_by_fault(rows_of(rows, false))).markdown();
  if (of_logs.empty()) return text;
  return text + "\n## Logs\n\n" + table_of_groups(groups_by_error(of_logs)).markdown() + '\n' +
         table_of_groups(groups_by_fault(of_logs)).markdown() + "\nThe logs without a fault:\n\n" +
         table_of_logs(rows).markdown();
}

}  // namespace

BenchReport verdict_report(const std::vector<VerdictRow>& rows, const VerdictBenchmarkOptions& options,
                           const std::string& machine) {
  const ReportTable maps = table_of_maps(rows);
  return {
      "verdict.md",
      markdown_of(rows, options, machine),
      json_file_text(report_json(
          "psi-slam-verdict", machine,
          {{"seeds", options.seeds.all()}, {"log_seeds", options.log_seeds.all()}, {"maps", maps.json()}})),
      maps.csv(),
      {}};
}

}  // namespace psi_slam
