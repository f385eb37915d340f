// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "config/nearest_name.h"
#include "psi_slam/user_error.h"
#include "session/edit_journal.h"

namespace psi_slam {
namespace {

using Kind = LoopEdit::Kind;

constexpr std::array<std::pair<const char*, Kind>, 4> kVerbs{{{"delete", Kind::kDelete},
                                                              {"force", Kind::kForce},
                                                              {"match", Kind::kMatch},
                                                              {"restore", Kind::kRestore}}};
constexpr std::array<const char*, 3> kPairKeys{"scan", "local_map", "after"};
constexpr std::array<const char*, 6> kMatchKeys{"matcher", "x_m", "y_m", "yaw_deg", "window_m", "window_deg"};
constexpr double kMaxWindow_m = 1000;

template <std::size_t N>
std::vector<std::string> strings(const std::array<const char*, N>& texts) {
  return {texts.begin(), texts.end()};
}

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const auto near = nearest_name(name, names);
  return near ? "; did you mean \"" + *near + "\"?" : "";
}

Kind kind_of(const std::string& verb) {
  std::vector<std::string> verbs;
  for (const auto& [text, kind] : kVerbs) {
    if (verb == text) return kind;
    verbs.emplace_back(text);
  }
  throw UserError("unknown edit \"" + verb + "\": expected delete, force, match or restore" +
                  did_you_mean(verb, verbs));
}

/// The key=value pairs of a line.
class Values {
 public:
  Values(std::istringstream& words, Kind kind) {
    std::vector<std::string> keys = strings(kPairKeys);
    if (kind == Kind::kForce) keys.emplace_back("attempt");
    if (kind == Kind::kMatch)
      for (const char* key : kMatchKeys) keys.emplace_back(key);
    for (std::string word; words >> word;) {
      const std::size_t equals = word.find('=');
      if (equals == std::string::npos) throw UserError("\"" + word + "\": expected KEY=VALUE");
      const std::string key = word.substr(0, equals);
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        throw UserError("unknown key \"" + key + "\"" + did_you_mean(key, keys));
      if (!values_.emplace(key, word.substr(equals + 1)).second)
        throw UserError("\"" + key + "\" is given twice");
    }
  }

  bool has(const char* key) const { return values_.count(key) != 0; }

  const std::string& text(const char* key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) throw UserError(std::string("\"") + key + "\" is missing");
    return found->second;
  }

  std::size_t whole(const char* key) const {
    const auto value = parse_number(text(key));
    if (!value || *value < 0 || *value > 1e15 || *value != std::floor(*value))
      throw UserError(std::string(key) + "=" + text(key) + ": expected a whole number, 0 or more");
    return static_cast<std::size_t>(*value);
  }

  double number(const char* key) const {
    const auto value = parse_number(text(key));
    if (!value) throw UserError(std::string(key) + "=" + text(key) + ": expected a number");
    return *value;
  }

  double radians(const char* key) const {
    const auto value = parse_degrees(text(key));
    if (!value) throw UserError(std::string(key) + "=" + text(key) + ": expected a number");
    return *value;
  }

 private:
  std::map<std::string, std::string> values_;
};

MatcherKind matcher_of(const std::string& text) {
  for (const MatcherKind kind : kMatcherKinds)
    if (text == name(kind)) return kind;
  throw UserError("matcher=" + text + ": expected csm, csm_ga or ga");
}

std::optional<LoopPlace> place_of(const Values& values) {
  constexpr std::array<const char*, 5> kKeys{"x_m", "y_m", "yaw_deg", "window_m", "window_deg"};
  if (std::none_of(kKeys.begin(), kKeys.end(), [&](const char* key) { return values.has(key); })) return {};
  LoopPlace place;
  place.anchor_T_node = {values.number("x_m"), values.number("y_m"), values.radians("yaw_deg")};
  const double window_m = values.number("window_m");
  if (!(window_m > 0 && window_m <= kMaxWindow_m))
    throw UserError("window_m=" + values.text("window_m") + ": expected a number above 0 and at most 1000");
  place.window = {window_m, window_m, values.radians("window_deg")};
  if (!(place.window.theta_rad > 0 && place.window.theta_rad <= M_PI))
    throw UserError("window_deg=" + values.text("window_deg") +
                    ": expected a number above 0 and at most 180");
  return place;
}

EditTime time_of(const Values& values) {
  if (!values.has("after")) return {};
  if (values.text("after") == "end") return {EditTime::Kind::kEnd, 0};
  return {EditTime::Kind::kAfterScan, values.whole("after")};
}

}  // namespace

std::string edit_line(const TimedEdit& timed) {
  const LoopEdit& edit = timed.edit;
  std::string line;
  for (const auto& [text, kind] : kVerbs)
    if (kind == edit.kind) line = text;
  line += " scan=" + std::to_string(edit.frame) + " local_map=" + std::to_string(edit.local_map);
  if (edit.kind == Kind::kMatch) line += std::string(" matcher=") + name(edit.matcher);
  if (edit.kind == Kind::kMatch && edit.place)
    line += " x_m=" + exact_text(edit.place->anchor_T_node.x) +
            " y_m=" + exact_text(edit.place->anchor_T_node.y) +
            " yaw_deg=" + exact_degrees_text(edit.place->anchor_T_node.phi) +
            " window_m=" + exact_text(edit.place->window.x_m) +
            " window_deg=" + exact_degrees_text(edit.place->window.theta_rad);
  if (edit.kind == Kind::kForce && edit.of_final_search) line += " attempt=final_search";
  if (timed.time.kind == EditTime::Kind::kAfterScan) line += " after=" + std::to_string(timed.time.scan);
  if (timed.time.kind == EditTime::Kind::kEnd) line += " after=end";
  return line;
}

TimedEdit parse_edit_line(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string verb;
  words >> verb;
  TimedEdit timed;
  timed.edit.kind = kind_of(verb);
  const Values values(words, timed.edit.kind);
  timed.edit.frame = values.whole("scan");
  timed.edit.local_map = values.whole("local_map");
  timed.time = time_of(values);
  if (values.has("attempt")) {
    const std::string& attempt = values.text("attempt");
    if (attempt != "final_search" && attempt != "last_pass")  // last_pass is its old name
      throw UserError("attempt=" + attempt + ": expected final_search");
    timed.edit.of_final_search = true;
  }
  if (timed.edit.kind == Kind::kMatch) {
    timed.edit.matcher = matcher_of(values.text("matcher"));
    timed.edit.place = place_of(values);
  }
  return timed;
}

}  // namespace psi_slam
