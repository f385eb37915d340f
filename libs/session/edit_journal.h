// SPDX-License-Identifier: BSD-3-Clause
// Edits of the loops of a log, each with the scan after which it is made. The same edits give the same map,
// whether they are made in the window or read from a file.
//
// The file is text, one line for each edit:
//
//     # psi-slam loop edits 1
//     delete scan=812 local_map=14 after=1500
//     force scan=812 local_map=15 after=end
//     force scan=813 local_map=15 attempt=final_search after=end
//     match scan=900 local_map=3 matcher=ga x_m=1.5 y_m=-2 yaw_deg=90 window_m=2 window_deg=30 after=1500
//     restore scan=812 local_map=14 after=1600
//
// Without `after`, an edit is made as soon as its scan and its local map exist. x_m, y_m and yaw_deg place
// the scan's robot in the local map; window_m and window_deg are half-widths. `match` works without these
// five. attempt=final_search forces a match that only the final loop search finds. Older files call it
// attempt=last_pass.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "psi_slam/loop_record.h"

namespace psi_slam {

/// A moment of a run, in the order of time.
struct EditTime {
  enum class Kind {
    kBegin,      ///< before the first scan
    kAfterScan,  ///< after `scan`, in the log's order, was mapped
    kEnd,        ///< after the last scan was mapped
  };
  Kind kind = Kind::kBegin;
  std::size_t scan = 0;

  bool operator<(const EditTime& other) const {
    return std::tie(kind, scan) < std::tie(other.kind, other.scan);
  }
};

struct TimedEdit {
  LoopEdit edit;
  EditTime time;
};

class EditJournal {
 public:
  /// All edits, in the order in which they are made.
  const std::vector<TimedEdit>& edits() const { return edits_; }
  bool empty() const { return edits_.empty(); }

  /// Adds an edit after those of the same time.
  void add(const TimedEdit& edit);
  void add(const EditJournal& others);

  /// Returns the edits that are due at `now` and were not returned before. At the end all are due, even those
  /// after scans that never came.
  std::vector<LoopEdit> take_due(EditTime now);
  /// The last edit of the same loop among those that were taken.
  std::optional<LoopEdit> in_force(const LoopEdit& same_loop) const;
  /// The edits of the same loop among those that were not taken yet.
  std::vector<TimedEdit> to_come(const LoopEdit& same_loop) const;
  /// Marks all edits as not taken, to map the same log again.
  void rewind() { taken_ = 0; }

  /// Enters an edit that is made now, as taken, and removes later edits of the same loop. Its time must not
  /// be before that of the edits taken.
  void enter(const TimedEdit& edit);
  /// Removes later edits of a loop. Returns false if there were none.
  bool forget_later(const LoopEdit& same_loop);

  /// The edits of a run that becomes one of several. Its scans are numbered from `first_scan`, its local maps
  /// from `first_local_map`. Edits at its end are made after the last of its `scans`.
  EditJournal of_run(std::size_t first_scan, std::size_t scans, std::size_t first_local_map) const;

  std::string text() const;
  /// Throws UserError, with file and line, for a line that is no edit.
  static EditJournal read(const std::filesystem::path& file);
  /// Parses a text; `file` is only for error messages. Throws like read().
  static EditJournal parse(const std::string& text, const std::filesystem::path& file);
  /// Throws SystemFailure if the file cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<TimedEdit> edits_;
  std::size_t taken_ = 0;
};

}  // namespace psi_slam
