// SPDX-License-Identifier: BSD-3-Clause
// What a person changed about the loops of a log, and when: each edit says after which scan it was made, so
// that the same edits give the same map whether they are made in the window or taken from a file.
//
// As a file it is text, a line an edit:
//
//     # psi-slam loop edits 1
//     delete scan=812 local_map=14 after=1500
//     force scan=812 local_map=15 after=end
//     force scan=813 local_map=15 attempt=final_search after=end
//     match scan=900 local_map=3 matcher=ga x_m=1.5 y_m=-2 yaw_deg=90 window_m=2 window_deg=30 after=1500
//     restore scan=812 local_map=14 after=1600
//
// Who writes one by hand may leave out `after`: such an edit is made as soon as its scan and its local map
// are there. x_m, y_m and yaw_deg place the scan's robot in the local map, window_m and window_deg are
// half-widths; `match` may do without these five.
// attempt=final_search is for a match that only the last pass finds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/loop_record.h"

namespace psi_slam {

/// A moment of a run. They are ordered.
struct EditTime {
  enum class Kind {
    kBegin,      ///< before the first scan
    kAfterScan,  ///< when `scan`, in the log's order, has been mapped
    kEnd,        ///< when the last one has
  };
  Kind kind = Kind::kBegin;
  std::size_t scan = 0;
};
bool operator<(const EditTime& a, const EditTime& b);

struct TimedEdit {
  LoopEdit edit;
  EditTime time;
};

class EditJournal {
 public:
  /// Of all edits, in the order in which they are made.
  const std::vector<TimedEdit>& edits() const { return edits_; }
  bool empty() const { return edits_.empty(); }

  /// Adds one behind those of the same time.
  void add(const TimedEdit& edit);
  void add(const EditJournal& others);

  /// The edits from the first that was not taken yet up to `now`; they count as taken. At the end all are
  /// due, those after scans that never came too.
  std::vector<LoopEdit> take_due(EditTime now);
  /// What was done last to the same loop, of the edits that were taken.
  std::optional<LoopEdit> in_force(const LoopEdit& same_loop) const;
  /// What is to be done to the same loop, of the edits that were not taken yet.
  std::vector<TimedEdit> to_come(const LoopEdit& same_loop) const;
  /// None is taken any more: for another run of the same log.
  void rewind() { taken_ = 0; }

  /// A person makes an edit now, which must be no earlier than what was taken: it is entered as taken, and
  /// what was to be done to the same loop later is forgotten.
  void enter(const TimedEdit& edit);
  /// Forgets what is to be done to a loop later; false when nothing was.
  bool forget_later(const LoopEdit& same_loop);

  /// The same of a drive that is one of several: its scans are numbered from `first_scan`, its local maps
  /// from `first_local_map`; what was made at its end is made after the last of its `scans`.
  EditJournal of_drive(std::size_t first_scan, std::size_t scans, std::size_t first_local_map) const;

  std::string text() const;
  /// Throws UserError, with file and line, on what is no edit.
  static EditJournal read(const std::filesystem::path& file);
  /// The same for a text in memory, as if it stood in a file called `file`.
  static EditJournal parse(const std::string& text, const std::filesystem::path& file);
  /// Throws SystemFailure when the disk does not take it.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<TimedEdit> edits_;
  std::size_t taken_ = 0;
};

}  // namespace psi_slam
