// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/report_html.h"

#include "base/number_text.h"
#include "map/report/html_text.h"
#include "map/report/report_sections.h"

namespace psi_slam {
namespace {

std::string files_list(std::size_t runs) {
  std::string list = "<ul class=\"files\">\n";
  const auto add = [&](const std::string& name, const std::string& what) {
    list += "<li><a href=\"" + name + "\">" + name + "</a> <span>" + what + "</span></li>\n";
  };
  add("map.png", "the map as an image");
  add("map.yaml", "with map.pgm, the map for ROS and nav2");
  add("map.gridmap.gz", "the map for MRPT");
  add("map.simplemap.gz", "nodes and scans for MRPT");
  add("trajectory.tum", "the path in TUM format, for evo");
  add("trajectory.csv", "the path with the covariance of each pose");
  if (runs <= 1) add("trajectory.carmen", "the corrected log");
  for (std::size_t run = 1; runs > 1 && run <= runs; ++run) {
    const std::string name = "trajectory-" + std::to_string(run);
    add(name + ".tum", "path of run " + std::to_string(run));
    add(name + ".carmen", "corrected log of run " + std::to_string(run));
  }
  add("graph.g2o", "the pose graph");
  add("frames.csv", "one row per scan");
  add("loops.csv", "one row per loop found");
  add("summary.json", "the figures of this report, for programs");
  return list + "</ul>\n";
}

std::string card(const std::string& title, const std::string& note, const std::string& content) {
  return "<section class=\"card\"><h2>" + title + (note.empty() ? "" : "<small>" + note + "</small>") +
         "</h2>\n" + content + "</section>\n";
}

std::string banner(const std::string& text) {
  return "<section class=\"card banner\">" + text + "</section>\n";
}

std::string stop_text(const RunSummary& summary) {
  const std::string scans = counted(summary.log.scans, "scan", "scans");
  if (!summary.final_search_cut_short)
    return "The run was stopped before the end of the log. This report covers the first " + scans + '.';
  return "The run was stopped after " + scans +
         ". The final loop search and the refinement of all scans were cut short.";
}

/// Returns a sentence such as "Mapped by psi-slam 0.1.0 in 51.3 s, 52 times faster than real time."
std::string story(const RunInfo& info, const RunSummary& summary) {
  std::string text = "Mapped by psi-slam";
  if (!info.program_version.empty()) text += ' ' + escape_html(info.program_version);
  text += " in " + duration_text(summary.wall_s);
  const double factor = summary.real_time_factor;
  if (factor >= 1.05) text += ", " + fixed_text(factor, factor < 10 ? 1 : 0) + " times faster than real time";
  if (factor > 0 && factor < 0.95) text += ", " + fixed_text(1 / factor, 1) + " times slower than real time";
  return text + '.';
}

std::string head(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title + " – psi-slam</title>\n<style>" + kReportStyle + "</style>\n</head>\n";
}

constexpr const char* kKey =
    "<span class=\"key\"></span>mean<span class=\"key range\"></span>minimum to maximum";

std::string response_key(const RunSummary& summary) {
  std::string key = fixed_text(summary.mean_response, 2) + " on average" + kKey;
  if (summary.loops.accepted > summary.loops.accepted_in_final_search)
    key += "<span class=\"key loops\"></span>a loop was closed";
  if (summary.unmatched.count > 0) key += "<span class=\"key unmatched\"></span>scans not matched";
  return key;
}

std::string loops_card(const MappingResult& result, const LoopCounts& loops) {
  std::string text = "<p class=\"none\">" + counted(loops.accepted, "loop was", "loops were") + " accepted";
  if (loops.accepted_in_final_search > 0)
    text += ", " + grouped(loops.accepted_in_final_search) + " of them in the final search";
  text += "; " + counted(loops.rejected, "was", "were") + " rejected";
  if (loops.by_hand > 0) text += "; " + counted(loops.by_hand, "was", "were") + " edited by hand";
  text += ".</p>\n";
  return card("Loops", "", text + loop_matchers_table(result) + reasons_table(loops) + loops_table(result));
}

}  // namespace

std::string report_html(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                        const mrpt::maps::COccupancyGridMap2D& grid) {
  const std::string name = escape_html(info.log_name.empty() ? "A run of psi-slam" : info.log_name);
  std::string html = head(name) + "<body>\n<main>\n<header>" + kReportLogo + "<div><h1>" + name + "</h1><p>" +
                     story(info, summary) + "</p></div></header>\n";
  if (summary.broken_off)
    html += banner("The log breaks off: " + escape_html(*summary.broken_off) + ". This report covers the " +
                   counted(summary.log.scans, "scan", "scans") + " before the break.");
  if (summary.interrupted) html += banner(stop_text(summary));
  if (const auto coarser = coarser_cells_text(summary.map)) html += banner(*coarser + '.');
  for (const std::string& warning : info.warnings) html += banner(escape_html(warning) + '.');
  html += key_figures(summary);
  if (summary.verdict)
    html += card("Verdict", text_of(summary.verdict->state), verdict_section(*summary.verdict));
  html += card("Map", "", report_map(result, summary, grid));
  html += card("Response of the front end", response_key(summary),
               response_plot(result, summary.unmatched) + unmatched_table(summary.unmatched));
  html += card("The factor Ψ and the searches that ran", psi_key(result), psi_plot(result));
  html += card("Loop matching time per node", kKey, loop_matching_plot(result));
  html += card("Time per stage", "with several threads, stages overlap: shares may add up to over 100 %",
               stages_table(result.stages, result.wall_s));
  html += card("Processing time per scan", kKey, work_plot(result));
  html += loops_card(result, summary.loops);
  html += "<div class=\"pair\">\n" + card("Input log", "", log_table(summary.log, info.log_name)) +
          card("Files in this folder", "", files_list(summary.runs.size())) + "</div>\n";
  html += card("Settings", "", settings_table(info.settings));
  return html + "</main>\n<script>" + kReportScript + "</script>\n</body>\n</html>\n";
}

}  // namespace psi_slam
