// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_journal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <sstream>
#include <utility>

#include "base/atomic_file.h"
#include "base/compression/compressed_file.h"
#include "base/compression/line_reader.h"
#include "base/number_text.h"
#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "map/exports/zone_files.h"
#include "map/rendering/placed_edits.h"
#include "mapping/loop_closure/loop_edit_line.h"
#include "psi_slam/user_error.h"
#include "session/edit_values.h"
#include "session/knowledge_line.h"
#include "session/map_edit_line.h"

namespace psi_slam {
namespace {

using Kind = LoopEdit::Kind;

constexpr double kMaxWindow_m = 1000;

Kind kind_of(const std::string& verb) {
  std::vector<std::string> verbs;
  for (const auto& [text, kind] : kLoopEditVerbs) {
    if (verb == text) return kind;
    verbs.emplace_back(text);
  }
  for (const auto& [text, kind] : kMapEditVerbs) verbs.emplace_back(text);
  verbs.insert(verbs.end(), kKnowledgeVerbs.begin(), kKnowledgeVerbs.end());
  throw UserError("unknown edit \"" + quotable(verb) + "\": expected " + name_list(verbs) +
                  did_you_mean(verb, verbs));
}

std::vector<std::string> keys_of(Kind kind) {
  std::vector<std::string> keys{"scan", "local_map", "after"};
  if (kind == Kind::kForce) keys.emplace_back("attempt");
  if (kind == Kind::kMatch)
    keys.insert(keys.end(), {"matcher", "x_m", "y_m", "yaw_deg", "window_m", "window_deg"});
  return keys;
}

MatcherKind matcher_of(const std::string& text) {
  for (const MatcherKind kind : kMatcherKinds)
    if (text == name(kind)) return kind;
  throw UserError("matcher=" + quotable(text) + ": expected csm, csm_ga or ga");
}

std::optional<LoopPlace> place_of(const EditValues& values) {
  constexpr std::array<const char*, 5> kKeys{"x_m", "y_m", "yaw_deg", "window_m", "window_deg"};
  if (std::none_of(kKeys.begin(), kKeys.end(), [&](const char* key) { return values.has(key); })) return {};
  LoopPlace place;
  place.anchor_T_node = {values.number("x_m"), values.number("y_m"), values.number("yaw_deg", parse_degrees)};
  const double window_m = values.number("window_m");
  if (!(window_m > 0 && window_m <= kMaxWindow_m))
    throw UserError("window_m=" + values.quoted("window_m") + ": expected a number above 0 and at most 1000");
  place.window = {window_m, window_m, values.number("window_deg", parse_degrees)};
  if (!(place.window.theta_rad > 0 && place.window.theta_rad <= M_PI))
    throw UserError("window_deg=" + values.quoted("window_deg") +
                    ": expected a number above 0 and at most 180");
  return place;
}

EditTime time_of(const EditValues& values) {
  if (!values.has("after")) return {};
  if (values.text("after") == "end") return {EditTime::Kind::kEnd, 0};
  return {EditTime::Kind::kAfterScan, values.whole("after")};
}

/// Text of an edit in the file, without line end.
std::string edit_line(const TimedEdit& timed) {
  std::string line = loop_edit_line(timed.edit);
  if (timed.time.kind == EditTime::Kind::kAfterScan) line += " after=" + std::to_string(timed.time.scan);
  if (timed.time.kind == EditTime::Kind::kEnd) line += " after=end";
  return line;
}

/// Parses a line of the file, without comment. Throws UserError, without file and line, if it is not an edit.
TimedEdit parse_edit_line(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string verb;
  words >> verb;
  TimedEdit timed;
  timed.edit.kind = kind_of(verb);
  const EditValues values(words, keys_of(timed.edit.kind));
  timed.edit.frame = values.whole("scan");
  timed.edit.local_map = values.whole("local_map");
  timed.time = time_of(values);
  if (values.has("attempt")) {
    const std::string& attempt = values.text("attempt");
    if (attempt != "final_search" && attempt != "last_pass")  // last_pass is the old name of final_search
      throw UserError("attempt=" + quotable(attempt) + ": expected final_search");
    timed.edit.of_final_search = true;
  }
  if (timed.edit.kind == Kind::kMatch) {
    timed.edit.matcher = matcher_of(values.text("matcher"));
    timed.edit.place = place_of(values);
  }
  return timed;
}

constexpr const char* kHeading = "# psi-slam loop edits 1\n";

bool earlier(const TimedEdit& a, const TimedEdit& b) {
  return a.time < b.time;
}

void add_line(std::string_view line, const std::string& place, EditJournal& journal) {
  line = line.substr(0, line.find('#'));
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  try {
    FixedKnowledge knowledge;
    if (parse_knowledge_line(line, place, knowledge))
      journal.add(knowledge);
    else if (const auto map_edit = parse_map_edit_line(line))
      journal.add(*map_edit);
    else
      journal.add(parse_edit_line(line));
  } catch (const UserError& error) {
    throw UserError(place + ": " + error.what());
  }
}

/// Checks the zones and tags of the edits in a file. Throws UserError with the file.
void check_zones_and_tags(const EditJournal& journal, const std::filesystem::path& file) {
  try {
    check_zones(journal.map_edits());
    check_tags(journal.knowledge());
  } catch (const UserError& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace

void EditJournal::add(const TimedEdit& edit) {
  edits_.insert(std::upper_bound(edits_.begin(), edits_.end(), edit, earlier), edit);
}

void EditJournal::add(const EditJournal& others) {
  for (const TimedEdit& edit : others.edits_) add(edit);
  for (const MapEdit& edit : others.map_edits_) add(edit);
  add(others.knowledge_);
}

void EditJournal::add(const FixedKnowledge& knowledge) {
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(knowledge_.poses, knowledge.poses);
  append(knowledge_.tags, knowledge.tags);
  append(knowledge_.sightings, knowledge.sightings);
}

std::vector<LoopEdit> EditJournal::take_due(EditTime now) {
  std::vector<LoopEdit> due;
  while (taken_ < edits_.size() && !(now < edits_[taken_].time)) due.push_back(edits_[taken_++].edit);
  return due;
}

std::optional<LoopEdit> EditJournal::in_force(const LoopEdit& same) const {
  for (std::size_t i = taken_; i-- > 0;)
    if (same_loop(edits_[i].edit, same)) return edits_[i].edit;
  return std::nullopt;
}

std::vector<TimedEdit> EditJournal::to_come(const LoopEdit& same) const {
  std::vector<TimedEdit> later;
  std::copy_if(edits_.begin() + static_cast<std::ptrdiff_t>(taken_), edits_.end(), std::back_inserter(later),
               [&](const TimedEdit& edit) { return same_loop(edit.edit, same); });
  return later;
}

void EditJournal::enter(const TimedEdit& edit) {
  forget_later(edit.edit);
  edits_.insert(edits_.begin() + static_cast<std::ptrdiff_t>(taken_), edit);
  ++taken_;
}

bool EditJournal::forget_later(const LoopEdit& same) {
  const auto later = edits_.begin() + static_cast<std::ptrdiff_t>(taken_);
  const auto kept =
      std::remove_if(later, edits_.end(), [&](const TimedEdit& edit) { return same_loop(edit.edit, same); });
  const bool any = kept != edits_.end();
  edits_.erase(kept, edits_.end());
  return any;
}

EditJournal EditJournal::of_run(std::size_t first_scan, std::size_t scans,
                                std::size_t first_local_map) const {
  EditJournal journal;
  for (MapEdit edit : map_edits_) {
    if (first_scan > 0 && !follows_run(edit)) continue;
    edit.scan += first_scan;
    journal.add(edit);
  }
  journal.knowledge_ = knowledge_;
  for (KnownPose& pose : journal.knowledge_.poses) pose.from_scan += first_scan;
  for (TagSighting& sighting : journal.knowledge_.sightings) sighting.from_scan += first_scan;
  for (TimedEdit edit : edits_) {
    edit.edit.frame += first_scan;
    edit.edit.local_map += first_local_map;
    if (edit.time.kind == EditTime::Kind::kAfterScan)
      edit.time.scan += first_scan;
    else if (edit.time.kind == EditTime::Kind::kEnd && first_scan + scans > 0)
      edit.time = {EditTime::Kind::kAfterScan, first_scan + scans - 1};
    else if (first_scan > 0)
      edit.time = {EditTime::Kind::kAfterScan, first_scan - 1};
    journal.add(edit);
  }
  return journal;
}

EditJournal EditJournal::with_frames(const mrpt::math::TPose2D& export_T_start) const {
  EditJournal journal = *this;
  for (MapEdit& edit : journal.map_edits_) edit = with_frame(std::move(edit), export_T_start);
  return journal;
}

std::string EditJournal::text() const {
  std::string text = kHeading;
  for (const TimedEdit& edit : edits_) text += edit_line(edit) + '\n';
  for (const MapEdit& edit : map_edits_) text += map_edit_line(edit) + '\n';
  return text + knowledge_lines(knowledge_);
}

EditJournal EditJournal::read(const std::filesystem::path& file) {
  EditJournal journal;
  LineReader lines(std::make_unique<CompressedFile>(file, "a file of edits"));
  for (std::string_view line; lines.next(line);) add_line(line, lines.place(), journal);
  check_zones_and_tags(journal, file);
  return journal;
}

EditJournal EditJournal::parse(const std::string& text, const std::filesystem::path& file) {
  EditJournal journal;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);)
    add_line(line, file.string() + ':' + std::to_string(++number), journal);
  check_zones_and_tags(journal, file);
  return journal;
}

void EditJournal::write(const std::filesystem::path& file) const {
  write_text_atomically(file, text());
}

}  // namespace psi_slam
