// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "map/report/html_text.h"
#include "map/report/report_sections.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMaxLoopsOfGroup = 100;

std::string degrees(double radians) {
  const std::string size = fixed_text(std::abs(radians) * 180 / M_PI, 1) + "°";
  return radians < 0 ? "−" + size : size;
}

/// Returns a length in centimetres: "5 cm", "2.5 cm", "10 cm".
std::string centimetres(double metres) {
  return trimmed_text(std::round(metres * 1000) / 10, 1) + " cm";
}

std::string tile(const std::string& name, const std::string& value, const std::string& unit,
                 const std::string& note) {
  return "<div class=\"tile\"><h3>" + name + "</h3><p class=\"figure\">" + value +
         (unit.empty() ? "" : " <small>" + unit + "</small>") + "</p><p class=\"note\">" + note +
         "</p></div>\n";
}

std::string fact(const std::string& name, const std::string& value) {
  return "<tr><th>" + name + "</th><td>" + value + "</td></tr>\n";
}

std::string cells(std::initializer_list<std::string> values) {
  std::string row;
  for (const std::string& value : values) row += "<td>" + value + "</td>";
  return row;
}

/// Returns the beginning of a table; `more` is HTML that follows the headings of the columns.
std::string table_begin(const std::string& css, std::initializer_list<const char*> columns,
                        const std::string& more = {}) {
  std::string head;
  for (const char* column : columns) head += std::string("<th>") + column + "</th>";
  return "<div class=\"" + css + "\"><table class=\"rows\">\n<thead><tr>" + head + more +
         "</tr></thead>\n<tbody>\n";
}

constexpr const char* kTableEnd = "</tbody></table></div>";

std::string bar(const std::string& css, double percent) {
  return "<span class=\"" + css + "\" style=\"width:" + fixed_text(percent, 1) + "%\"></span>";
}

constexpr int kLastGroup = 4;

/// Returns the place of a loop in the table: edits by hand, accepted loops, outlier loops, candidates,
/// others.
int group_of(const LoopRecord& loop) {
  if (loop.by_hand) return 0;
  if (loop.state == LoopState::kAccepted) return 1;
  if (is_outlier(loop)) return 2;
  return loop.state == LoopState::kCandidate ? 3 : kLastGroup;
}

std::string loop_row(const LoopRecord& loop) {
  const std::string css = loop.state == LoopState::kAccepted   ? "good"
                          : loop.state == LoopState::kRejected ? "bad"
                                                               : "warn";
  return "<tr><td><span class=\"badge " + css + "\">" + state_text(loop.state) + "</span></td>" +
         cells({grouped(loop.frame), grouped(loop.node), grouped(loop.local_map), searched_by(loop),
                fixed_text(loop.response, 3), fixed_text(loop.ambiguity, 2),
                fixed_text(loop.observed_share, 2), fixed_text(loop.neighbours_agree, 2),
                fixed_text(loop.reverse_agree, 2), fixed_text(loop.moved_m, 2),
                milliseconds_text(loop.milliseconds)}) +
         "<td class=\"text\">" + escape_html(text_of(loop.rejection)) +
         (loop.in_final_search ? " (final search)" : "") + "</td></tr>\n";
}

}  // namespace

std::string key_figures(const RunSummary& summary) {
  const MappedLogFacts& log = summary.log;
  const double rate_hz =
      log.duration_s > 0 && log.scans > 1 ? static_cast<double>(log.scans - 1) / log.duration_s : 0;
  const LoopCounts& loops = summary.loops;
  const MapExtent& map = summary.map;
  const double factor = summary.real_time_factor;
  const std::string speed = factor > 0 ? fixed_text(factor, factor < 10 ? 1 : 0) + "×" : "–";
  std::string html = "<section class=\"tiles\">\n";
  html += tile("Duration", minutes_text(log.duration_s), log.duration_s < 3600 ? "min" : "h",
               fixed_text(rate_hz, 1) + " scans per second");
  html +=
      tile("Scans", grouped(log.scans), "",
           grouped(log.beams) + " beams per scan" +
               (summary.unmatched.count > 0 ? ", " + grouped(summary.unmatched.count) + " not matched" : ""));
  html += tile("Path", grouped(summary.path_length_m, 0), "m",
               "odometry: " + grouped(log.odometry_length_m, 0) + " m");
  html += tile("Free space", grouped(map.free_m2, 0), "m²",
               fixed_text(map.width_m(), 0) + " × " + fixed_text(map.height_m(), 0) + " m, cells of " +
                   centimetres(map.resolution_m));
  html += tile("Graph", grouped(summary.nodes), "nodes",
               counted(summary.edges, "edge", "edges") + ", " +
                   counted(summary.local_maps, "local map", "local maps"));
  html += tile("Loops closed", grouped(loops.accepted), "", "of " + grouped(loops.tried) + " tried");
  html += tile("Real-time factor", speed, "", "mapped in " + duration_text(summary.wall_s));
  html += tile("Peak memory", grouped(summary.peak_memory_mib, 0), "MiB", "of the process");
  return html + "</section>\n";
}

std::string log_table(const MappedLogFacts& log, const std::string& name) {
  std::string html = "<table class=\"facts\">\n";
  html += fact("Log", escape_html(name));
  html += fact("Scans", grouped(log.scans) + " of " + grouped(log.beams) + " beams, " +
                            degrees(log.first_bearing_rad) + " to " + degrees(log.last_bearing_rad));
  html += fact("Returns", fixed_text(100 * log.returns, 1) + " % of the beams, maximum range " +
                              fixed_text(log.max_range_m, 1) + " m");
  if (log.companion_scans + log.spare_scans > 0)
    html += fact("Further lasers", counted(log.companion_scans, "scan", "scans") +
                                       " synchronised with the first laser, " + grouped(log.spare_scans) +
                                       " left out because no scan of the first laser is near in time");
  html += fact("Laser mount", "x " + fixed_text(log.robot_T_laser.x, 3) + " m, y " +
                                  fixed_text(log.robot_T_laser.y, 3) + " m, yaw " +
                                  degrees(log.robot_T_laser.phi));
  html += fact("Time", format_seconds(log.first_time_us) + " to " + format_seconds(log.last_time_us) +
                           " s (" + duration_text(log.duration_s) + ")");
  html += fact("Order", log.stamps_back == 0
                            ? std::string("time stamps never decrease")
                            : counted(log.stamps_back, "time stamp decreases", "time stamps decrease") +
                                  "; scans stay in file order");
  html += fact("Odometry", grouped(log.odometry_length_m, 1) + " m");
  return html + "</table>\n";
}

std::string verdict_section(const MapVerdict& verdict) {
  const std::string sentence = verdict_sentence(verdict);
  std::string html = "<p class=\"none\">" + escape_html(sentence) + ".</p>\n";
  if (verdict.hot_spots.empty()) return html;
  const std::vector<HotSpot>& spots = verdict.hot_spots;
  std::string rows;
  for (auto spot = spots.begin(); spot != spots.end(); ++spot) {
    if (std::any_of(spots.begin(), spot,
                    [&](const HotSpot& worse) { return is_same(worse.suspect, spot->suspect); }))
      continue;
    rows += "<tr>" +
            cells({text_of(spot->kind), fixed_text(spot->at.x, 1), fixed_text(spot->at.y, 1),
                   error_text(*spot), grouped(spot->places_of_suspect)}) +
            "<td class=\"text\">" + escape_html(text_of(spot->suspect)) + "</td><td class=\"text\">" +
            escape_html(advice_text(*spot)) + "</td></tr>\n";
  }
  html += table_begin("wide tall", {"Worst place of a suspect", "x, m", "y, m", "error", "places", "Suspect",
                                    "What would help"}) +
          rows + kTableEnd;
  if (verdict.more_hot_spots > 0)
    html += "<p class=\"none\">Rings and rows are of the worst " + counted(spots.size(), "place") + "; " +
            counted(verdict.more_hot_spots, "more is", "more are") + " left out.</p>";
  return html + '\n';
}

std::string unmatched_table(const UnmatchedScans& unmatched) {
  if (unmatched.count == 0) return {};
  std::string rows;
  for (const UnmatchedStretch& stretch : unmatched.stretches)
    rows += "<tr>" +
            cells({grouped(stretch.first_frame) + " to " + grouped(stretch.last_frame),
                   format_seconds(stretch.first_time_us), format_seconds(stretch.last_time_us),
                   fixed_text(stretch.predicted_length_m, 2)}) +
            "</tr>\n";
  return "<details><summary>" + counted(unmatched.count, "scan", "scans") + " not matched, in " +
         counted(unmatched.stretches.size(), "stretch", "stretches") + "</summary>" +
         table_begin("wide tall", {"Scans", "from, s", "to, s", "path by odometry, m"}) + rows + kTableEnd +
         "</details>\n";
}

std::string reasons_table(const LoopCounts& loops) {
  if (loops.reasons.empty()) return "<p class=\"none\">No loop was rejected.</p>\n";
  const std::size_t most = loops.reasons.front().count;
  std::string html = "<table class=\"bars\">\n";
  for (const ReasonCount& reason : loops.reasons) {
    const double share = 100 * static_cast<double>(reason.count) / static_cast<double>(most);
    html += "<tr><td class=\"number\">" + grouped(reason.count) + "</td><td>" +
            bar("bar bad", std::max(share, 1.0)) + escape_html(text_of(reason.reason)) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

std::string stages_table(const std::vector<StageTiming>& stages, double wall_s) {
  if (stages.empty()) return "<p class=\"none\">No stage was timed.</p>\n";
  std::string html =
      table_begin("wide", {"Stage", "calls", "mean ± std", "[min, max] ms", "total", "share of the run"});
  for (const StageTiming& stage : stages) {
    const double share = wall_s > 0 ? 100 * stage.total_s / wall_s : 0;
    html += "<tr><th>" + escape_html(stage.name) + "</th>" +
            cells({grouped(stage.calls),
                   milliseconds_text(stage.mean_ms) +
                       (stage.calls > 1 ? " ± " + milliseconds_text(stage.std_ms) : ""),
                   "[" + milliseconds_text(stage.min_ms) + ", " + milliseconds_text(stage.max_ms) + "]",
                   duration_text(stage.total_s)}) +
            "<td class=\"share\">" + bar("bar", std::clamp(share, 0.5, 100.0)) + "<b>" +
            fixed_text(share, 1) + " %</b></td></tr>\n";
  }
  return html + kTableEnd + "\n";
}

std::string loop_matchers_table(const MappingResult& result) {
  if (result.loop_matchers.empty()) return {};
  const auto row = [](const std::string& matcher, const std::string& search, const SearchCost& cost,
                      std::size_t closed, const std::string& final_search) {
    const double tries = static_cast<double>(std::max<std::size_t>(cost.attempts, 1));
    return "<tr><th>" + matcher + "</th>" +
           cells({search, grouped(cost.attempts), grouped(cost.found), grouped(closed),
                  grouped(static_cast<double>(cost.evaluations) / tries, 0),
                  milliseconds_text(cost.milliseconds / tries), duration_text(cost.milliseconds * 1e-3),
                  final_search}) +
           "</tr>\n";
  };
  std::string html =
      table_begin("wide", {"Matcher chosen", "search that ran", "tried", "found", "closed",
                           "poses scored per try", "ms per try", "total time", "time in the final search"});
  for (const auto& [kind, matcher] : result.loop_matchers) {
    html += row(name(kind), "all", matcher.effort, matcher.accepted,
                duration_text(matcher.final_search_effort.milliseconds * 1e-3));
    for (const SearchKind search : kSearchKinds)
      if (const SearchCost& cost = matcher.effort.of(search); cost.attempts > 0)
        html += row({}, name(search), cost, matcher.accepted_by_search[static_cast<std::size_t>(search)],
                    duration_text(matcher.final_search_effort.of(search).milliseconds * 1e-3));
  }
  return html + kTableEnd + "\n";
}

std::string loops_table(const MappingResult& result) {
  const auto found = static_cast<std::size_t>(std::count_if(
      result.loops.begin(), result.loops.end(), [](const LoopRecord& loop) { return !found_nothing(loop); }));
  if (found == 0) return "<p class=\"none\">No match was found.</p>\n";
  std::string rows;
  std::size_t shown = 0;
  for (int group = 0; group <= kLastGroup; ++group) {
    std::size_t of_group = 0;
    for (const LoopRecord& loop : result.loops) {
      if (found_nothing(loop) || group_of(loop) != group || of_group == kMaxLoopsOfGroup) continue;
      ++of_group;
      ++shown;
      rows += loop_row(loop);
    }
  }
  const std::size_t left = found - shown;
  return "<details><summary>" + counted(found, "match found", "matches found") + "</summary>" +
         table_begin("wide tall",
                     {"State", "scan", "node", "local map", "matcher (search)", "response", "ambiguity",
                      "observed", "neighbours", "reverse", "moved, m", "ms"},
                     "<th class=\"text\">why</th>") +
         rows + kTableEnd +
         (left > 0 ? "<p class=\"none\">" + counted(left, "more is", "more are") +
                         " in <a href=\"loops.csv\">loops.csv</a>.</p>"
                   : "") +
         "</details>\n";
}

std::string settings_table(const std::map<std::string, std::string>& settings) {
  if (settings.empty()) return "<p class=\"none\">No settings recorded.</p>\n";
  std::map<std::string, std::map<std::string, std::string>> sections;
  for (const auto& [key, value] : settings) {
    const std::size_t point = key.find('.');
    const bool has_section = point != std::string::npos;
    sections[has_section ? key.substr(0, point) : ""][has_section ? key.substr(point + 1) : key] = value;
  }
  std::string html = "<details><summary>" + counted(settings.size(), "setting", "settings") +
                     "</summary><div class=\"settings\">\n";
  for (const auto& [section, keys] : sections) {
    html += "<table class=\"facts\"><caption>" + escape_html(section.empty() ? "general" : section) +
            "</caption>\n";
    for (const auto& [key, value] : keys)
      html += fact(escape_html(key), "<code>" + escape_html(value) + "</code>");
    html += "</table>\n";
  }
  return html + "</div></details>\n";
}

}  // namespace psi_slam
