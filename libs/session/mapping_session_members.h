// SPDX-License-Identifier: BSD-3-Clause
// State of a mapping session, which the source files of MappingSession share.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "map/verdict/map_verdict.h"
#include "mapping/stage_clock.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"
#include "psi_slam/mapping_session.h"
#include "session/edit_journal.h"
#include "session/session_input.h"
#include "session/session_journal.h"
#include "session/session_prior.h"
#include "session/session_recording.h"
#include "session/settings.h"
#include "session/superseded_scans.h"

namespace psi_slam {

struct MappingSession::Members {
  enum class State {
    kReading,   ///< the log may have more scans
    kRead,      ///< all scans are taken: the log ended, is damaged, or finish() was called
    kFinished,  ///< the map is finished
  };

  /// Changes the state. Allowed: kReading -> kRead when the log ends and in finish(), kRead -> kFinished in
  /// finish(), kFinished -> kRead in reopen(), kRead -> kReading in begin_run(). Other transitions throw
  /// std::logic_error.
  void enter(State next);
  void read_from(OpenedInput opened);
  std::optional<Frame> read();
  void keep_bent(const Frame& frame);
  void keep_superseded(std::size_t scan, const Frame& frame);
  const std::vector<Frame>& recorded_frames(std::vector<Frame>& room) const;
  const std::vector<Frame>& whole_log(std::vector<Frame>& room, std::vector<std::string>& complaints) const;
  bool is_unchecked() const { return state == State::kFinished && scans_checked != result.log.size(); }
  void check_log(const std::vector<Frame>& log);
  void check_knowledge(const EditJournal& further) const;
  void make_due_edits(EditTime now);
  void begin_recorded_run();
  SessionFacts facts() const;
  void update_journal() const;
  const std::vector<Frame>& mapped_log() const {
    return state == State::kFinished ? result.log : mapper->log();
  }
  /// SHA-256 of the log; empty if the log is no longer readable or became shorter.
  std::string checksum_of_log() const;
  void begin(SessionProgress::Phase new_phase);
  void report(double share) const;

  std::shared_ptr<const SessionRecording> recording;  ///< null if there is no recorded session
  std::filesystem::path log_path;                     ///< the log that is read; empty without a log
  std::uintmax_t log_bytes = 0;                       ///< its size when it was opened
  mutable std::string log_sha256;                     ///< cache of checksum_of_log()
  /// For the last log, scans_left means that readable scans are known to remain.
  std::vector<RecordedLog> logs;
  std::vector<RecordedRun> later_runs;
  Settings settings;
  std::string settings_text;  ///< text of a settings file with all of `settings`
  std::vector<std::string> settings_warnings;
  std::unique_ptr<FrameSource> source;
  /// Frames without odometry as the log states them, by their numbers: the mapper deskews its own copies.
  /// Frames whose ranges the mapper has discarded are removed after a while.
  std::map<std::size_t, Frame> bent;
  SupersededScans superseded;
  std::size_t most_bent = 1000;    ///< size of `bent` at which discarded frames are removed
  std::unique_ptr<Mapper> mapper;  ///< null after finish() without stay_open()
  Mapper::AfterFinish after_finish = Mapper::AfterFinish::kNothing;
  EditJournal edits;
  std::vector<std::string> edit_complaints;
  std::vector<std::string> map_edit_complaints;  ///< those of the last export
  std::optional<SessionPrior> prior;             ///< empty without a prior map
  Observer observer;
  State state = State::kReading;
  MappingResult result;
  std::optional<MapVerdict> verdict;        ///< of `result`; empty before it is drawn
  std::unique_ptr<SessionJournal> journal;  ///< null if the session is not recorded continuously
  std::optional<std::string> broken_off;
  std::vector<std::string> faults;  ///< see faults_of_log()
  std::size_t scans_checked = 0;    ///< number of scans for which `faults` was determined
  StageClock reading_clock{"read log"};
  SessionProgress::Phase phase = SessionProgress::Phase::kMapping;
  double phase_began_s = 0;  ///< value of work_s when the phase began
  double work_s = 0;         ///< time of work, without pauses between calls
  std::size_t scans = 0;
  /// Number of entries of result.contradictions that precede those of the export.
  std::size_t contradictions_of_mapping = 0;
  std::size_t stages_of_mapping = 0;  ///< number of entries of result.stages that precede those of the export
};

}  // namespace psi_slam
