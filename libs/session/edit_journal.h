// SPDX-License-Identifier: BSD-3-Clause
// Edits of the loops of a log, each with the scan after which it is made, and edits of the drawn map. The
// same edits give the same map, whether they are made in the window or read from a file.
//
// The file is text, one line for each edit:
//
//     # psi-slam loop edits 1
//     delete scan=812 local_map=14 after=1500
//     force scan=812 local_map=15 after=end
//     force scan=813 local_map=15 attempt=final_search after=end
//     match scan=900 local_map=3 matcher=ga x_m=1.5 y_m=-2 yaw_deg=90 window_m=2 window_deg=30 after=1500
//     restore scan=812 local_map=14 after=1600
//     erase polygon=1,2;3,2;3,4.5
//     unknown polygon=5,5;6,5;6,6
//     wall line=0,0;4,0;4,2 width_m=0.1
//     crop polygon=-10,-10;30,-10;30,20;-10,20
//     keep_out polygon=7,1;9,1;9,3
//     slow polygon=10,1;12,1;12,3 percent=40
//     slow polygon=10,1;12,1;12,3 max_speed_mps=0.3
//     erase polygon=1,2;3,2;3,4.5 frame=2.5,0,90
//     erase polygon=1,2;3,2;3,4.5 frame=0,0,0 scan=1500
//
// Without `after`, an edit is made as soon as its scan and its local map exist. x_m, y_m and yaw_deg are the
// pose of the robot at the scan in the frame of the local map; window_m and window_deg are half-widths of the
// search window. `match` also works without these five. attempt=final_search forces a match that only the
// final loop search finds. Older files call it attempt=last_pass.
//
//     pose time_s=1700000000.5 x_m=1 y_m=2 yaw_deg=90 sigma_m=0.02 sigma_deg=1
//     tag name=A x_m=4 y_m=5 sigma_m=0.02
//     seen name=A time_s=1700000012 ahead_m=1.5 left_m=-0.2 sigma_m=0.03
//
// The edits from `erase` to `slow` change the drawn map, see MapEdit. They are made in the order of their
// lines, after the last scan. Their points are metres: in the frame of the exported map, or in a frame in
// which the robot has the pose `frame` (x, y, yaw in degrees) at its first scan, or at the scan `scan`.
// The lines from `pose` on state what is known from outside, see FixedKnowledge.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "map/rendering/map_edits.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/loop_record.h"

namespace psi_slam {

/// A moment of a run. Earlier moments compare as less.
struct EditTime {
  enum class Kind {
    kBegin,      ///< before the first scan
    kAfterScan,  ///< after `scan`, counted in the log's order from 0, was mapped
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

/// A change that a person makes: of a loop, or of the drawn map.
using AnyEdit = std::variant<LoopEdit, MapEdit>;

inline std::string text_of(const AnyEdit& edit) {
  return std::visit([](const auto& of_kind) { return text_of(of_kind); }, edit);
}

/// Returns whether an edit can follow its run into a map of several runs: it states its frame, and it is no
/// crop, which would cut off the other runs.
inline bool follows_run(const MapEdit& edit) {
  return edit.frame_T_robot && edit.kind != MapEdit::Kind::kCrop;
}

class EditJournal {
 public:
  /// All edits of loops, in the order in which they are made.
  const std::vector<TimedEdit>& edits() const { return edits_; }
  /// Edits of the drawn map, in their order.
  const std::vector<MapEdit>& map_edits() const { return map_edits_; }
  /// What is known from outside, in the order of the lines.
  const FixedKnowledge& knowledge() const { return knowledge_; }
  /// Number of edits, without the lines of knowledge().
  std::size_t size() const { return edits_.size() + map_edits_.size(); }
  bool empty() const { return size() == 0 && knowledge_.empty(); }

  /// Inserts an edit by its time, after the edits of the same time.
  void add(const TimedEdit& edit);
  void add(const MapEdit& edit) { map_edits_.push_back(edit); }
  /// Removes the last edit of the drawn map, if there is one.
  void remove_last_map_edit() {
    if (!map_edits_.empty()) map_edits_.pop_back();
  }
  void add(const FixedKnowledge& knowledge);
  /// Adds all edits of another journal.
  void add(const EditJournal& others);

  /// Returns the edits that are due at `now` and were not returned before. At the end all edits are due, even
  /// edits after scans that the log does not have.
  std::vector<LoopEdit> take_due(EditTime now);
  /// Returns the last edit of the same loop as `same_loop` that take_due() returned or enter() entered.
  std::optional<LoopEdit> in_force(const LoopEdit& same_loop) const;
  /// Returns the edits of the same loop as `same_loop` that are still to come.
  std::vector<TimedEdit> to_come(const LoopEdit& same_loop) const;
  /// Makes all edits due again, to map the same log again.
  void rewind() { taken_ = 0; }

  /// Enters an edit that is made now, so take_due() will not return it. Removes the edits of the same loop
  /// that are not made yet. No edit that take_due() has returned may have a later time.
  void enter(const TimedEdit& edit);
  /// Removes the edits of a loop that are not made yet. Returns false if there were none.
  bool forget_later(const LoopEdit& same_loop);

  /// Returns these edits of one run, renumbered for a map of several runs. The run has `scans` scans,
  /// numbered from `first_scan`, and local maps numbered from `first_local_map`. Edits at the end of the run
  /// are made after its last scan. Of a run that is not the first one, keeps only the edits of the drawn map
  /// for which follows_run() is true. Knowledge is kept for all runs, because it states its own frame.
  EditJournal of_run(std::size_t first_scan, std::size_t scans, std::size_t first_local_map) const;

  /// Returns the edits with the frame of each edit of the drawn map, see with_frame().
  EditJournal with_frames(const mrpt::math::TPose2D& export_T_start) const;

  /// Returns the edits as the text of a file.
  std::string text() const;
  /// Reads a file. Throws UserError, with file and line, for a line that is not an edit, and with the file
  /// as check_zones() and check_tags() do.
  static EditJournal read(const std::filesystem::path& file);
  /// Parses the text of a file; `file` is only for error messages. Throws as read() does.
  static EditJournal parse(const std::string& text, const std::filesystem::path& file);
  /// Writes the file. Throws SystemFailure if it cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::vector<TimedEdit> edits_;
  std::vector<MapEdit> map_edits_;
  FixedKnowledge knowledge_;
  std::size_t taken_ = 0;  ///< number of edits that take_due() has returned or enter() has entered
};

}  // namespace psi_slam
