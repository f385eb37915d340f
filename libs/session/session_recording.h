// SPDX-License-Identifier: BSD-3-Clause
// All that it takes to make a map again: the frames that the mapper was given, to the last bit, and what was
// said to it. The mapper's own state is not recorded: the same program makes the same state of the same
// frames, and another version a better one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"
#include "session/edit_journal.h"

namespace psi_slam {

/// A log that frames were read from.
struct RecordedLog {
  std::string name;       ///< of the file, without its folder
  std::string sha256;     ///< see sha256_of_log(); empty: it was gone when it was asked for
  std::size_t scans = 0;  ///< that were taken from its beginning
  SkippedLines skipped{};
  std::optional<std::string> broken_off{};  ///< what is wrong with it behind its last frame
  bool scans_left = false;                  ///< it has more of them, as far as is known
};

/// A drive behind the first: see RunStart.
struct RecordedRun {
  std::size_t scan = 0;  ///< its first, in the order of all frames
  RunStart start;
};

struct SessionFacts {
  std::string program_version;
  std::vector<RecordedLog> logs;  ///< in the order of their frames
  std::vector<RecordedRun> runs;
  std::string settings;  ///< a settings file with every option
  EditJournal edits;
};

struct SessionRecording {
  SessionFacts facts;
  std::vector<Frame> frames;
};

}  // namespace psi_slam
