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
       state("check", MapState::kCheck),
       state("broken", MapState::kBroken),
       {{"fault found", "located"},
        [](const Group& group) {
          const std::size_t faults = count_of(group.rows, is_fault_to_locate);
          return faults == 0 ? empty_cell() : cell(share_text(count_of(group.rows, is_located), faults));
        }}},
      groups);
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

ReportTable table_of_maps(const Rows& rows) {
  return table_of<VerdictRow>(
      {{{"fault", "fault", true}, [](const VerdictRow& row) { return cell(name_of(row.fault)); }},
       {{"seed", "seed"}, [](const VerdictRow& row) { return cell(static_cast<std::size_t>(row.seed)); }},
       column("error [m]", "error_m", &VerdictRow::error_m, 4),
       {{"verdict", "state", true}, [](const VerdictRow& row) { return cell(text_of(row.state)); }},
       column("doubt [m]", "doubt_m", &VerdictRow::doubt_m, 4),
       column("hot spots", "hot_spots", &VerdictRow::hot_spots),
       {{"distance [m]", "distance_m"}, [](const VerdictRow& row) { return cell(row.distance_m, 2); }},
       column("time [ms]", "judge_ms", &VerdictRow::judge_ms, 1)},
      rows);
}

std::string markdown_of(const Rows& rows, const VerdictBenchmarkOptions& options,
                        const std::string& machine) {
  const std::optional<double> area = area_under_curve(rows);
  std::string text =
      "# How far the verdict can be trusted\n\nThis page shows how well psi-slam judges its maps without "
      "ground truth. The maps are of simulated buildings, so their true errors are known.\n\n" +
      measured_by(machine) + "; " + seeds_text(options.seeds) + ", " + std::to_string(rows.size()) +
      " maps of paths from " + fixed_text(options.path_m, 0) + " m on.\n\n";
  text +=
      "- true error: mean distance of the scans from the truth, after the best rigid alignment of both "
      "paths\n"
      "- doubt: the figure that ranks the maps, in metres: the estimated mean error, and the predicted "
      "uncertainty where it is large\n"
      "- false loop, nearby loop, loop group: one false loop, one true loop moved by 1 to 3 m, or five false "
      "loops that agree, with full weight and without the defence of the mapper; one of 60 true loops is "
      "kept\n"
      "- no loops: loop closing off, one of 2 to 5 scans, ranges up to 4 to 8 m, noisy odometry\n"
      "- slip: wheels slip by 0.3 to 0.8 m and 6 to 14 degrees while the laser is blind for 2.5 m; loop "
      "closing off\n"
      "- carried: the robot is moved by 8 to 18 m while it is off\n"
      "- thinned: one of 4 to 11 scans, ranges up to 8 m, noisy odometry\n"
      "- fault found: of the maps with one fault and an error above 0.05 m, those where the suspect of the "
      "worst place is at most 2 m from the fault\n\n";
  text += "The area under the ROC curve, between maps up to 0.05 m and maps above 0.25 m: " +
          (area ? fixed_text(*area, 4) : "–") +
          ". Faults found: " + share_text(count_of(rows, is_located), count_of(rows, is_fault_to_locate)) +
          ". Processor time of a verdict: " +
          fixed_text(spread_over(rows, [](const VerdictRow& row) { return row.judge_ms; }).mean, 1) +
          " ms on average.\n\n";
  return text + table_of_groups(groups_by_error(rows)).markdown() + '\n' +
         table_of_groups(groups_by_fault(rows)).markdown();
}

}  // namespace

BenchReport verdict_report(const std::vector<VerdictRow>& rows, const VerdictBenchmarkOptions& options,
                           const std::string& machine) {
  const ReportTable maps = table_of_maps(rows);
  return {"verdict.md",
          markdown_of(rows, options, machine),
          json_file_text(report_json("psi-slam-verdict", machine,
                                     {{"seeds", options.seeds.all()}, {"maps", maps.json()}})),
          maps.csv(),
          {}};
}

}  // namespace psi_slam
