// SPDX-License-Identifier: BSD-3-Clause
// All that is needed to make a map again: the mapper's frames, to the last bit, its settings and the edits.
// The mapper's state is not recorded, because the same program derives the same state from the same frames.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"
#include "session/edit_journal.h"
#include "session/log_calibration.h"

namespace psi_slam {

/// A log that frames were read from.
struct RecordedLog {
  std::string name;       ///< name of the file, without folder
  std::string sha256;     ///< see sha256_of_log(); empty if the log was unreadable when the session was saved
  std::size_t scans = 0;  ///< number of scans taken, from the log's beginning
  SkippedLines skipped{};
  std::optional<std::string> broken_off{};      ///< damage after the last frame, as a sentence
  bool scans_left = false;                      ///< whether the log is known to have more scans
  std::optional<LogCalibration> calibration{};  ///< by which the log was read; empty if nothing is replaced
  std::vector<std::string> assumptions{};       ///< of the reader, such as scans that it left out
};

/// A merged run other than the first one; see RunStart.
struct RecordedRun {
  std::size_t scan = 0;  ///< the run's first scan, in the order of all frames
  RunStart start;
};

/// The prior map of a run.
struct RecordedPrior {
  std::string map;     ///< value of prior.map
  std::string sha256;  ///< see sha256_of_map_file()
};

struct SessionFacts {
  std::string program_version;
  std::vector<RecordedLog> logs;  ///< in the order of their frames
  std::vector<RecordedRun> runs;
  std::string settings;  ///< text of a settings file with every option
  EditJournal edits;
  std::optional<RecordedPrior> prior{};  ///< empty without a prior map, and in files of older versions
};

struct SessionRecording {
  SessionFacts facts;
  std::vector<Frame> frames;
  /// What is missing at the end of a journal, a sentence without full stop; empty if nothing is.
  std::optional<std::string> lost_end{};
};

}  // namespace psi_slam
