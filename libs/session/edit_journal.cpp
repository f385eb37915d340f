// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_journal.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>
#include <tuple>

#include "base/atomic_file.h"
#include "compression/line_reader.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr const char* kHeading = "# psi-slam loop edits 1\n";

bool earlier(const TimedEdit& a, const TimedEdit& b) {
  return a.time < b.time;
}

void add_line(std::string_view line, const std::string& place, EditJournal& journal) {
  line = line.substr(0, line.find('#'));
  if (line.find_first_not_of(" \t") == std::string_view::npos) return;
  try {
    journal.add(parse_edit_line(line));
  } catch (const UserError& error) {
    throw UserError(place + ": " + error.what());
  }
}

}  // namespace

bool operator<(const EditTime& a, const EditTime& b) {
  return std::tie(a.kind, a.scan) < std::tie(b.kind, b.scan);
}

void EditJournal::add(const TimedEdit& edit) {
  edits_.insert(std::upper_bound(edits_.begin(), edits_.end(), edit, earlier), edit);
}

void EditJournal::add(const EditJournal& others) {
  for (const TimedEdit& edit : others.edits_) add(edit);
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

std::string EditJournal::text() const {
  std::string text = kHeading;
  for (const TimedEdit& edit : edits_) text += edit_line(edit) + '\n';
  return text;
}

EditJournal EditJournal::read(const std::filesystem::path& file) {
  EditJournal journal;
  LineReader lines(file);
  for (std::string_view line; lines.next(line);) add_line(line, lines.place(), journal);
  return journal;
}

EditJournal EditJournal::parse(const std::string& text, const std::filesystem::path& file) {
  EditJournal journal;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);)
    add_line(line, file.string() + ':' + std::to_string(++number), journal);
  return journal;
}

void EditJournal::write(const std::filesystem::path& file) const {
  write_text_atomically(file, text());
}

}  // namespace psi_slam
