// SPDX-License-Identifier: BSD-3-Clause
#include "base/number_text.h"
#include "batch/kept_run.h"
#include "live/live_benchmark.h"

namespace psi_slam {
namespace {

using Column = ColumnOf<LiveRow>;

Column time_column(const std::string& head, const std::string& key, double LiveRow::*time_ms) {
  return {{head, key}, [=](const LiveRow& row) { return cell(row.*time_ms, 2); }};
}

Column error_column(const std::string& head, const std::string& key,
                    std::optional<double> LiveRow::*error_m) {
  return {{head, key}, [=](const LiveRow& row) {
            return row.*error_m ? cell(*(row.*error_m), 4) : ReportCell{"–", nullptr};
          }};
}

ReportTable rows_table(const std::vector<LiveRow>& rows) {
  using Row = LiveRow;
  return table_of<Row>({column("log", "log", &Row::log),
                        {{"speed", "speed"},
                         [](const Row& row) {
                           return ReportCell{
                               row.speed == 0 ? "as fast as possible" : "× " + trimmed_text(row.speed, 2),
                               row.speed};
                         }},
                        {{"processors", "processors"},
                         [](const Row& row) { return cell(static_cast<std::size_t>(row.processors)); }},
                        column("scans", "scans", &Row::scans),
                        column("timed scans", "timed_scans", &Row::timed_scans),
                        time_column("scan to pose, mean [ms]", "latency_ms.mean", &Row::mean_ms),
                        time_column("p50 [ms]", "latency_ms.p50", &Row::p50_ms),
                        time_column("p99 [ms]", "latency_ms.p99", &Row::p99_ms),
                        time_column("max [ms]", "latency_ms.max", &Row::max_ms),
                        column("missed deadlines", "missed_deadlines", &Row::missed_deadlines),
                        time_column("processor time per scan [ms]", "cpu_ms", &Row::cpu_ms),
                        error_column("error while mapping [m]", "live_m", &Row::live_m),
                        error_column("error before the final steps [m]", "mapped_m", &Row::mapped_m),
                        error_column("error of the finished map [m]", "final_m", &Row::final_m)},
                       rows);
}

}  // namespace

BenchReport live_report(const LiveBenchmark& benchmark, const LiveBenchmarkOptions& options,
                        const std::string& machine) {
  const ReportTable rows = rows_table(benchmark.rows);
  const std::string text =
      "# Mapping while the robot drives\n\nLogs are replayed at the speed of their time stamps, and the time "
      "from each scan to its pose is measured.\n\n" +
      measured_by(machine) +
      ".\n\n"
      "- Each replay is a process of its own that may use the stated number of processors. The back end has "
      "threads of its own.\n"
      "- scan to pose: from the moment when a scan is due, so waiting counts. As fast as possible: from the "
      "moment when the mapper begins with the scan.\n"
      "- missed deadline: a scan that waited for the result of the back end that was due. "
      "`live.latency_nodes` "
      "sets the deadline.\n"
      "- error while mapping: mean translation error over the relations of the poses that the mapper gave at "
      "once. Nothing that came later corrected them.\n"
      "- error before the final steps: mean translation error of the map after the last scan\n"
      "- Pauses of a log longer than 2 s are replayed as 2 s.\n\n" +
      rows.markdown() + '\n' + logs_section(benchmark.identities, benchmark.without_relations);
  return {"live.md",
          text,
          json_file_text(report_json("psi-slam-live-benchmark", machine,
                                     {{"speeds", options.speeds},
                                      {"processors", options.processors},
                                      {"simulated_m", options.simulated_m},
                                      {"stretch_s", options.stretch_s},
                                      {"timed_s", options.timed_s},
                                      {"logs", logs_table(benchmark.identities).json()},
                                      {"rows", rows.json()}})),
          rows.csv(),
          {}};
}

}  // namespace psi_slam
