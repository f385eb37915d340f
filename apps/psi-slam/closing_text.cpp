// SPDX-License-Identifier: BSD-3-Clause
#include "closing_text.h"

#include <mrpt/core/format.h>

#include <filesystem>
#include <system_error>

#include "base/number_text.h"

namespace psi_slam {
namespace {

/// The verdict and what would help at the worst place, without full stop.
std::string text_of(const MapVerdict& verdict) {
  std::string text = verdict_sentence(verdict);
  if (!verdict.hot_spots.empty()) text += ". Try: " + advice_text(verdict.hot_spots.front());
  return text;
}

}  // namespace

std::string closing_text(const RunSummary& summary, const std::string& log_name, const OutputFolder& folder) {
  const std::filesystem::path picture = folder.path() / "map.png";
  const std::string report = (folder.path() / "report.html").string();
  std::error_code ignored;
  const bool has_picture = std::filesystem::exists(picture, ignored);  // false without map.write_png
  std::string lines = "The map is in " + (has_picture ? picture : folder.path()).string() +
                      ", the report in " + report + ".\n";
  lines += counted(summary.log.scans, "scan") + " of " + log_name + " over " +
           minutes_text(summary.log.duration_s) + mrpt::format(" and %.0f m: ", summary.path_length_m) +
           counted(summary.nodes, "node") + ", " + counted(summary.loops.accepted, "loop") + " closed.\n";
  lines += mrpt::format("It took %.1f s", summary.wall_s);
  if (summary.real_time_factor > 0)
    lines += mrpt::format(", real-time factor %.1f", summary.real_time_factor);
  lines += mrpt::format(", and %.0f MiB of memory.\n", summary.peak_memory_mib);
  if (summary.verdict && summary.verdict->state != MapState::kBroken)
    lines += "Verdict: " + text_of(*summary.verdict) + ".\n";
  return lines;
}

std::optional<std::string> broken_map_text(const RunSummary& summary) {
  if (!summary.verdict || summary.verdict->state != MapState::kBroken) return std::nullopt;
  return text_of(*summary.verdict);
}

std::string interrupted_text(std::size_t scans) {
  return "interrupted: the map will show the " + std::to_string(scans) +
         " scans and the loops found so far. Interrupt again to stop without a map";
}

std::string broken_off_text(const std::string& why, std::size_t scans) {
  return why + "; the map shows the " + std::to_string(scans) + " scans before that";
}

std::string stages_text(const MappingResult& result) {
  std::string lines;
  for (const StageTiming& stage : result.stages)
    lines +=
        mrpt::format("%-24s %8zu x  %9.3f ± %.3f ms  [%.3f, %.3f]  %8.2f s\n", stage.name.c_str(),
                     stage.calls, stage.mean_ms, stage.std_ms, stage.min_ms, stage.max_ms, stage.total_s);
  return lines;
}

}  // namespace psi_slam
