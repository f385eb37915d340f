// SPDX-License-Identifier: BSD-3-Clause
// One run from a log to a map: the engine that the headless app and the GUI both drive, scan by scan.
//
//     MappingSession session("my.log", settings);
//     while (session.step()) {}              // or: session.run(stop)
//     session.finish();
//     session.export_to(OutputFolder::prepare("out", false));
//
// It holds neither windows nor signals: who drives it stops by not calling step() again, and finish() makes
// a map of what was read until then.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"
#include "report/output_folder.h"
#include "session/edit_journal.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

struct SessionProgress {
  enum class Phase {
    kMapping,   ///< reading the log and mapping its scans
    kFinalSearch,  ///< the last search for loops and the last optimisation
    kWriting,   ///< drawing the map and writing all files
  };

  Phase phase = Phase::kMapping;
  double share = 0;       ///< of the phase that is done, in [0, 1]; while mapping, of the log
  std::size_t scans = 0;  ///< mapped so far
  double scans_per_s = 0;
  double elapsed_s = 0;               ///< of work, pauses left out
  std::optional<double> remaining_s;  ///< of the phase, as far as it can be told
};

/// What a session file holds that was written.
struct SavedSession {
  std::size_t scans = 0;  ///< all that were recorded, where not all have been mapped again
  std::string remark;     ///< what it lacks, a sentence without its full stop; empty: nothing
};

class MappingSession {
 public:
  using Observer = std::function<void(const SessionProgress&)>;

  /// Opens the log. Throws UserError when it cannot be read, and when settings contradict each other.
  MappingSession(const std::filesystem::path& log, const Settings& settings);
  /// The same of a recording, and what goes on behind it. The map is that of one run
  /// that was never interrupted, to the last bit, where the settings that shape it are the recording's.
  MappingSession(const SessionInput& input, const Settings& settings);
  ~MappingSession();
  MappingSession(const MappingSession&) = delete;
  MappingSession& operator=(const MappingSession&) = delete;

  /// Is told after every scan, at the beginning of every phase and now and then within, in the thread that
  /// drives the session.
  void set_observer(Observer observer) { observer_ = std::move(observer); }

  /// Maps the next scan. False at the end of the log, and where it breaks off: see broken_off(). Throws
  /// UserError when it breaks off before the first scan.
  bool step();

  /// What is wrong with the log behind its last readable scan, as a sentence.
  const std::optional<std::string>& broken_off() const { return broken_off_; }
  /// Whether that log or one before it does.
  bool breaks_off() const;
  /// What is missing of the logs before the last, now or when they were recorded, as sentences: where one
  /// breaks off, and which was not read to its end.
  std::vector<std::string> warnings_of_logs_before() const;

  /// What was left out of what the session has read.
  SkippedLines skipped_lines() const;

  /// Edits that are made on the way, each at its time, besides those of the input. Call it before the
  /// first step().
  void add_edits(const EditJournal& edits);

  /// Changes a loop by hand, now. After finish(), which must have been told to stay open, the map is what it
  /// was before, and finish() is to be called again.
  LoopEditOutcome edit(const LoopEdit& edit);

  /// Edits that an edit made the journal forget are to be made again, each at its time; now where that has
  /// passed.
  void plan(const std::vector<TimedEdit>& edits);

  /// How many, this one and those that were merged before.
  std::size_t runs() const { return runs_.size() + 1; }

  /// What was changed until now and what is to be changed later: with it, the same log and the same settings
  /// give the same map.
  const EditJournal& edits() const { return edits_; }

  /// After finish(): the edits that could not be made, a sentence each.
  std::vector<std::string> unmet_edits() const;
  /// What the user is to know of this run: damage of the log, and edits that were not made; a sentence each.
  std::vector<std::string> warnings() const;

  /// After finish() edits are still taken. It costs memory.
  void stay_open() { stays_open_ = true; }
  bool finished() const { return finished_; }
  /// Takes back finish(): it is to be called again.
  void reopen();

  /// Ends the mapping. Once `stop` is true the last pass is cut short. The result is marked as interrupted,
  /// by the user, when readable scans of the log were left unread or the last pass was cut short. Throws
  /// UserError when no scan had a return.
  void finish(const std::atomic<bool>& stop);
  void finish() { finish(std::atomic<bool>(false)); }

  /// Steps to the end of the log, or, from the first scan on, until `stop` is true; and finishes.
  void run(const std::atomic<bool>& stop);

  /// Goes on with another drive through the same building, which begins there: see place_run(). Needs
  /// finish() and stay_open(); finish() is to be called again. Throws UserError when the drive cannot be
  /// read.
  void begin_run(const SessionInput& drive, const RunStart& start);

  /// Draws the map and writes all results. Needs finish(); may be called again for another folder. Throws
  /// SystemFailure when the disk does not take them. The figures returned are those of summary.json and
  /// report.html; their times include all but the writing of these two.
  RunSummary export_to(const OutputFolder& folder);

  /// Writes what was mapped until now, with all edits and settings, as a session file: see SessionInput.
  /// Where not all of a recording has been mapped yet, it is written whole nevertheless. Throws SystemFailure
  /// when the disk does not take it.
  SavedSession save(const std::filesystem::path& file) const;

  /// Until finish(), and when the session was opened again: the poses, the graph and the loops so far.
  const Mapper& mapper() const { return *mapper_; }

  /// After finish().
  const MappingResult& result() const { return result_; }

  /// What the summary and the report say of the program, the log and the settings.
  RunInfo run_info() const;

 private:
  class WorkClock;
  std::optional<Frame> read();
  void make_due_edits(EditTime now);
  void write_edits(const std::filesystem::path& file) const;
  void begin_recorded_run();
  SessionFacts facts() const;
  /// Empty where it cannot be read any more.
  std::string checksum_of_log() const;
  void begin(SessionProgress::Phase phase);
  void tell(double share) const;

  std::shared_ptr<const SessionRecording> recording_;  // null: none
  std::filesystem::path path_;                         // of the log that is read; empty: none
  mutable std::string log_sha256_;                     // of that, once it was asked for
  std::vector<RecordedLog> logs_;
  std::vector<RecordedRun> runs_;
  Settings settings_;
  std::unique_ptr<FrameSource> source_;
  std::unique_ptr<Mapper> mapper_;  // gone after finish() unless the session stays open
  EditJournal edits_;
  std::vector<std::string> edit_complaints_;
  Observer observer_;
  MappingResult result_;
  std::optional<std::string> broken_off_;
  StageClock reading_clock_{"read log"};
  SessionProgress::Phase phase_ = SessionProgress::Phase::kMapping;
  double phase_began_s_ = 0;  // of the work
  double work_s_ = 0;         // as of now, pauses between calls left out
  std::size_t scans_ = 0;
  std::size_t stages_of_mapping_ = 0;  // in result_.stages; those of an export come behind
  bool stays_open_ = false;
  bool finished_ = false;
  bool scans_left_ = false;  // readable ones of the last log, behind the last that was mapped
  bool any_return_ = false;
  bool at_end_ = false;
};

}  // namespace psi_slam
