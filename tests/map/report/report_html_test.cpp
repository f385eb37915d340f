// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/report_html.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "doubtful_map.h"
#include "map/report/output_folder.h"
#include "psi_slam/grid_map.h"
#include "simulated_room.h"
#include "well_formed.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string report_of(const MappingResult& result, const RunInfo& info) {
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  return report_html(result, info, summarize_run(result, *grid), *grid);
}

std::string report_of_the_room() {
  return report_of(walk_around_the_room(), {"0.1.0", "room.clf", {{"seed", "1"}}});
}

std::string without_style_and_script(const std::string& html) {
  return without(without(html, "<style>", "</style>"), "<script>", "</script>");
}

/// Returns the values of an attribute, each cut after 40 characters.
std::vector<std::string> values_of(const std::string& attribute, const std::string& html) {
  std::vector<std::string> values;
  const std::string begin = ' ' + attribute + "=\"";
  for (std::size_t at = 0; (at = html.find(begin, at)) != std::string::npos;) {
    at += begin.size();
    values.push_back(html.substr(at, std::min<std::size_t>(html.find('"', at) - at, 40)));
  }
  return values;
}

TEST(WellFormed, finds_each_kind_of_error) {
  EXPECT_EQ(complaint_about("<!DOCTYPE html><p class=\"a b\">x &amp; y<br/></p>"), "");
  for (const char* wrong :
       {"<p>", "</p>", "<p></b>", "<p class=a></p>", "<p class=\"<\"></p>", "<p>&x</p>", "<p>></p>", "<p"})
    EXPECT_NE(complaint_about(wrong), "") << wrong;
}

TEST(ReportHtml, has_well_formed_tags_and_drawings) {
  const std::string html = without_style_and_script(report_of_the_room());
  EXPECT_EQ(complaint_about(html), "");
  EXPECT_THAT(html, HasSubstr("<svg id=\"map\""));
  EXPECT_THAT(html, HasSubstr("class=\"plot\""));
}

TEST(ReportHtml, counts_the_scans_of_further_lasers) {
  const MappingResult result = walk_around_the_room();
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  RunSummary summary = summarize_run(result, *grid);
  EXPECT_THAT(report_html(result, {}, summary, *grid), Not(HasSubstr("Further lasers")));
  summary.log.companion_scans = 48;
  summary.log.spare_scans = 1200;
  EXPECT_THAT(
      report_html(result, {}, summary, *grid),
      HasSubstr(
          "<th>Further lasers</th><td>48 scans synchronised with the first laser, 1,200 left out because "
          "no scan of the first laser is near in time</td>"));
}

TEST(ReportHtml, shows_the_places_to_check) {
  const MappingResult result = walk_around_the_room();
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  RunSummary summary = summarize_run(result, *grid);
  EXPECT_THAT(report_html(result, {}, summary, *grid), Not(HasSubstr("<h2>Verdict")));
  summary.verdict = doubtful_map();
  const std::string html = report_html(result, {}, summary, *grid);
  EXPECT_EQ(complaint_about(without_style_and_script(html)), "");
  EXPECT_THAT(html, HasSubstr("<h2>Verdict<small>check these places</small>"));
  EXPECT_THAT(html, HasSubstr("id=\"show-hot-spots\""));
  EXPECT_THAT(html, HasSubstr("<td>0.31 m</td><td>1</td><td class=\"text\">the loop of scan 45"));
  EXPECT_THAT(html, HasSubstr("delete scan=45 local_map=3"));
  EXPECT_THAT(html, HasSubstr("<circle "));
  EXPECT_THAT(html, Not(HasSubstr("left out.</p>")));
}

TEST(ReportHtml, has_one_row_for_each_suspect) {
  const MappingResult result = walk_around_the_room();
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  RunSummary summary = summarize_run(result, *grid);
  MapVerdict verdict = doubtful_map();
  verdict.hot_spots.resize(3, verdict.hot_spots[0]);
  verdict.hot_spots[0].error_m = 1;
  verdict.hot_spots[0].places_of_suspect = 4;
  verdict.hot_spots[1].suspect.kind = Suspect::Kind::kStretch;
  verdict.more_hot_spots = 2;
  summary.verdict = verdict;
  const std::string html = report_html(result, {}, summary, *grid);
  EXPECT_EQ(complaint_about(without_style_and_script(html)), "");
  EXPECT_THAT(html, HasSubstr("<td>1 m or more</td><td>4</td><td class=\"text\">the loop of scan 45"));
  EXPECT_THAT(html, HasSubstr("Rings and rows are of the worst 3 places; 2 more are left out."));
  const std::string row = "<tr><td>doubled wall</td>";
  const std::size_t first = html.find(row);
  ASSERT_NE(first, std::string::npos);
  const std::size_t second = html.find(row, first + 1);
  ASSERT_NE(second, std::string::npos);
  EXPECT_EQ(html.find(row, second + 1), std::string::npos) << "the third place has the first suspect";
}

TEST(ReportHtml, needs_no_network) {
  const std::string html = report_of_the_room();
  EXPECT_THAT(html, Not(HasSubstr("://")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  EXPECT_TRUE(values_of("src", html).empty());
  for (const std::string& reference : values_of("href", html))
    EXPECT_TRUE(reference.rfind("data:image/png;base64,", 0) == 0 ||
                reference.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789.") == std::string::npos)
        << reference;
}

TEST(ReportHtml, shows_the_figures) {
  const std::string html = report_of_the_room();
  for (const char* shown :
       {"room.clf", "20×", "10 <small>nodes</small>", "match scan to local map", "the response is too low",
        "1 setting", "of 12 tried", "2 matches found", "Mapped by psi-slam 0.1.0 in 0.50 s"})
    EXPECT_THAT(html, HasSubstr(shown));
}

TEST(ReportHtml, shows_the_factor_and_the_searches_that_ran) {
  const std::string html = report_of_the_room();
  for (const char* shown : {"Ψ₁ = 2", "Ψ₂ = 6", "<path class=\"search branch_and_bound\"",
                            "<path class=\"search local\"", "key search local", "csm (branch_and_bound)"})
    EXPECT_THAT(html, HasSubstr(shown));
  EXPECT_THAT(html, Not(HasSubstr("<path class=\"search genetic\"")));
  MappingResult one = walk_around_the_room();
  for (FrameRecord& frame : one.frames) {
    frame.searches = {};
    if (frame.node) frame.searches[static_cast<std::size_t>(SearchKind::kGenetic)] = 3;
  }
  const std::string of_one = report_of(one, {});
  EXPECT_THAT(of_one, HasSubstr("<path class=\"search genetic\""));
  EXPECT_THAT(of_one, Not(HasSubstr("<path class=\"search local\"")));
  EXPECT_THAT(of_one, Not(HasSubstr("key search local")));
}

TEST(ReportHtml, splits_the_matchers_by_the_searches_that_ran) {
  const std::string html = without_style_and_script(report_of_the_room());
  EXPECT_THAT(html, HasSubstr("<tr><th>csm</th><td>all</td><td>12</td><td>2</td><td>1</td>"));
  EXPECT_THAT(html, HasSubstr("<tr><th></th><td>exhaustive</td><td>9</td><td>1</td><td>0</td>"));
  EXPECT_THAT(html, HasSubstr("<tr><th></th><td>branch_and_bound</td><td>3</td><td>1</td><td>1</td>"));
  EXPECT_THAT(html, Not(HasSubstr("<td>genetic</td>")));
}

TEST(ReportHtml, shows_unmatched_scans_in_figures_map_and_plot) {
  MappingResult result = walk_around_the_room();
  const std::string without = without_style_and_script(report_of(result, {}));
  EXPECT_THAT(without, Not(HasSubstr("not matched")));
  EXPECT_THAT(without, Not(HasSubstr("show-unmatched")));
  result.frames[10].match = result.frames[11].match = result.frames[20].match = ScanMatch::kUnmatched;
  const std::string html = without_style_and_script(report_of(result, {}));
  EXPECT_EQ(complaint_about(html), "");
  for (const char* shown :
       {"181 beams per scan, 3 not matched", "unmatched scans (3)", "<title>2 scans not matched</title>",
        "<path class=\"unmatched\" d=\"M", "3 scans not matched, in 2 stretches", "<td>10 to 11</td>"})
    EXPECT_THAT(html, HasSubstr(shown));
}

TEST(ReportHtml, escapes_texts_of_the_user) {
  const std::string nasty = "<script>alert('&\"')</script>\x01";
  MappingResult result = walk_around_the_room();
  result.stages[0].name = nasty;
  const std::string html = report_of(result, {nasty, nasty, {{nasty, nasty}, {"a." + nasty, nasty}}});
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;&amp;&quot;&#39;)&lt;/script&gt;?"));
  EXPECT_EQ(complaint_about(without_style_and_script(html)), "");
}

TEST(ReportHtml, shows_empty_and_interrupted_runs) {
  MappingResult result;
  result.interrupted = true;
  const std::string html = report_of(result, {});
  EXPECT_THAT(html, HasSubstr("stopped before the end of the log"));
  EXPECT_THAT(html, HasSubstr("No match was found"));
  EXPECT_THAT(html, HasSubstr("No times were measured"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(ReportHtml, shows_psi_for_any_thresholds) {
  for (const auto& [psi_1, psi_2] :
       {std::pair{-1.0, 1.0}, {0.0, 1e-300}, {-2.0, -1.0}, {1.0, 1.0}, {1.0, 4.0}, {1e200, 1e300}}) {
    MappingResult result = walk_around_the_room();
    result.psi.psi_1 = psi_1;
    result.psi.psi_2 = psi_2;
    const std::string html = report_of(result, {});
    EXPECT_EQ(complaint_about(without_style_and_script(html)), "") << psi_1 << ", " << psi_2;
    EXPECT_THAT(html, Not(HasSubstr("nan")));
    EXPECT_THAT(html, Not(HasSubstr("inf")));
    EXPECT_EQ(html.find("Ψ₁ = Ψ₂ = 1<") != std::string::npos, psi_1 == psi_2);
    EXPECT_EQ(html.find("Ψ₁ = ") != std::string::npos, psi_1 > 0);
    EXPECT_EQ(html.find("Ψ₂ = ") != std::string::npos, psi_2 > 0);
  }
}

TEST(ReportHtml, reports_a_map_that_is_coarser_than_asked_for) {
  const MappingResult result = walk_around_the_room();
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  RunSummary summary = summarize_run(result, *grid);
  EXPECT_THAT(report_html(result, {}, summary, *grid), Not(HasSubstr("map.max_cells")));
  summary.map.asked_resolution_m = 0.0125;
  EXPECT_THAT(report_html(result, {}, summary, *grid),
              HasSubstr("map.max_cells limits the map to cells of 0.05 m instead of 0.0125 m."));
}

TEST(ReportHtml, reports_why_the_log_breaks_off) {
  MappingResult result = walk_around_the_room();
  result.broken_off = "a<b.log:41: expected 181 ranges";
  const std::string html = report_of(result, {});
  EXPECT_THAT(html,
              HasSubstr("The log breaks off: a&lt;b.log:41: expected 181 ranges. This report covers the "
                        "50 scans before the break."));
  EXPECT_THAT(html, Not(HasSubstr("stopped")));
}

TEST(ReportHtml, reports_that_the_final_search_was_cut_short) {
  MappingResult result = walk_around_the_room();
  EXPECT_THAT(report_of(result, {}), Not(HasSubstr("cut short")));
  result.interrupted = result.final_search_cut_short = true;
  EXPECT_THAT(
      report_of(result, {}),
      HasSubstr(
          "The run was stopped after 50 scans. The final loop search and the refinement of all scans were "
          "cut short."));
}

}  // namespace
}  // namespace psi_slam
