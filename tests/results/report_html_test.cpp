// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/results/report_html.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "psi_slam/results/grid_map.h"
#include "psi_slam/results/output_folder.h"
#include "simulated_room.h"

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

std::string without(std::string html, const std::string& begin, const std::string& end) {
  for (std::size_t at = 0; (at = html.find(begin, at)) != std::string::npos;)
    html.erase(at, html.find(end, at) + end.size() - at);
  return html;
}

/// What is wrong with the tags of a page or drawing; empty when each is closed in its turn, attributes are
/// quoted and no bare '&' or '<' is left.
std::string complaint_about(const std::string& html) {
  static const std::set<std::string> kVoid = {"meta", "input", "!DOCTYPE"};
  static const std::regex kTag("<(/?)([!A-Za-z][A-Za-z0-9]*)((?: [a-zA-Z0-9-]+(?:=\"[^\"<]*\")?)*)(/?)>");
  static const std::regex kEntity("&(amp|lt|gt|quot|#39);");
  std::vector<std::string> open;
  std::size_t text_begin = 0;
  for (auto tag = std::sregex_iterator(html.begin(), html.end(), kTag); tag != std::sregex_iterator();
       ++tag) {
    const auto position = static_cast<std::size_t>(tag->position());
    const std::string text = std::regex_replace(html.substr(text_begin, position - text_begin), kEntity, "");
    if (text.find_first_of("<>&") != std::string::npos) return "bare sign in: " + text.substr(0, 80);
    text_begin = position + static_cast<std::size_t>(tag->length());
    const std::string name = (*tag)[2];
    if ((*tag)[4].length() > 0 || kVoid.count(name) > 0) continue;
    if ((*tag)[1].length() == 0) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

TEST(ReportHtml, its_tags_and_drawings_are_well_formed) {
  std::string html = report_of_the_room();
  html = without(without(html, "<style>", "</style>"), "<script>", "</script>");
  html = std::regex_replace(html, std::regex("base64,[A-Za-z0-9+/=]+"), "base64,");
  EXPECT_EQ(complaint_about(html), "");
  EXPECT_THAT(html, HasSubstr("<svg id=\"map\""));
  EXPECT_THAT(html, HasSubstr("class=\"plot\""));
}

TEST(ReportHtml, needs_no_network) {
  const std::string html = report_of_the_room();
  EXPECT_THAT(html, Not(HasSubstr("://")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("<link")));
  const std::regex reference("(?:href|src)=\"([^\"]{0,40})");
  for (auto found = std::sregex_iterator(html.begin(), html.end(), reference);
       found != std::sregex_iterator(); ++found)
    EXPECT_TRUE(std::regex_search((*found)[1].str(), std::regex("^(data:image/png|[a-z0-9.]+$)")))
        << (*found)[1];
}

TEST(ReportHtml, shows_the_figures) {
  const std::string html = report_of_the_room();
  for (const char* shown :
       {"room.clf", "20×", "10 <small>nodes</small>", "match scan to local map", "response … is below …",
        "1 setting", "2 loops tried", "Mapped by psi-slam 0.1.0 in 0.50 s"})
    EXPECT_THAT(html, HasSubstr(shown));
}

TEST(ReportHtml, the_users_texts_cannot_break_it) {
  const std::string nasty = "<script>alert('&\"')</script>\x01";
  MappingResult result = walk_around_the_room();
  result.loops[0].reason = nasty;
  result.stages[0].name = nasty;
  result.frames[0].matcher = nasty;
  result.loops[0].matcher = nasty;
  std::string html = report_of(result, {nasty, nasty, {{nasty, nasty}, {"a." + nasty, nasty}}});
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(&#39;&amp;&quot;&#39;)&lt;/script&gt;?"));
  html = without(without(html, "<style>", "</style>"), "<script>", "</script>");
  html = std::regex_replace(html, std::regex("base64,[A-Za-z0-9+/=]+"), "base64,");
  EXPECT_EQ(complaint_about(html), "");
}

TEST(ReportHtml, an_empty_and_an_interrupted_run_are_shown_too) {
  MappingResult result;
  result.interrupted = true;
  const std::string html = report_of(result, {});
  EXPECT_THAT(html, HasSubstr("stopped before the end of the log"));
  EXPECT_THAT(html, HasSubstr("No loop was tried"));
  EXPECT_THAT(html, HasSubstr("No times were measured"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace psi_slam
