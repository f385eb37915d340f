// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Maps a log from its first scan to the finished map. psi-slam and psi-slam-gui both drive this class scan
/// by scan.
///
///     psi_slam::Configuration configuration;
///     psi_slam::MappingSession session("my.log", configuration);
///     while (session.step()) {}
///     session.finish();
///     session.export_to("out");
///
/// The class depends on neither windows nor signals. To stop early, call finish() instead of step(): the map
/// then holds the scans that were read. run(stop) does the same as the loop and finish().
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/mapper.h"

namespace psi_slam {

class Configuration;
class EditJournal;
class OutputFolder;
class SessionInput;
struct DrawnMap;
struct MapEdit;
struct RunInfo;
struct RunSummary;
struct Settings;
struct SkippedLines;
struct TimedEdit;

/// Progress of a session, for progress bars.
struct SessionProgress {
  /// Part of the work.
  enum class Phase {
    kMapping,      ///< reading the log and mapping its scans
    kPriorSearch,  ///< aligning the run with the prior map; only with prior.map
    kFinalSearch,  ///< final loop search, last optimisation and joint refinement
    kWriting,      ///< drawing the map and writing all files
  };

  Phase phase = Phase::kMapping;  ///< current part of the work
  double share = 0;        ///< completed share of the phase, in [0, 1]; while mapping, share of the log read
  std::size_t scans = 0;   ///< number of scans mapped so far
  double scans_per_s = 0;  ///< scans mapped per second, averaged over elapsed_s
  double elapsed_s = 0;    ///< working time, without the pauses between calls
  std::optional<double> remaining_s;  ///< estimated time left in the phase; empty while share is 0
};

/// Content of a session file that was written.
struct SavedSession {
  std::size_t scans = 0;  ///< number of saved scans, including recorded scans that were not mapped again
  std::string remark;     ///< what the file lacks, a sentence without full stop; empty if complete
};

/// Maps a log, a recorded session, or a recorded session and a log that continues it. A resumed session
/// gives the same map, to the last bit, as a run without interruption, if the settings that shape the map
/// are equal.
class MappingSession {
 public:
  /// Function that receives the progress.
  using Observer = std::function<void(const SessionProgress&)>;

  /// Opens a log. Throws UserError if it is unreadable or if settings contradict each other. warnings()
  /// includes the warnings of the configuration.
  MappingSession(const std::filesystem::path& log, const Configuration& configuration);
  /// Opens a log. Throws UserError if it is unreadable or if settings contradict each other.
  MappingSession(const std::filesystem::path& log, const Settings& settings);
  /// Opens a log or a recorded session. Throws UserError like the constructor for logs. warnings() begins
  /// with `settings_warnings`.
  MappingSession(const SessionInput& input, const Settings& settings,
                 std::vector<std::string> settings_warnings = {});
  ~MappingSession();
  MappingSession(const MappingSession&) = delete;
  MappingSession& operator=(const MappingSession&) = delete;

  /// Sets the function that is called after every scan, at the start of every phase but the first, and
  /// sometimes within a phase. The function runs in the thread that drives the session. If it throws while
  /// finish() runs, finish() skips the remaining steps, and throws the exception when the map is finished.
  void set_observer(Observer observer);
  /// Sets the function that is called as soon as the pose of a scan is known, see
  /// Mapper::set_pose_observer().
  void set_pose_observer(Mapper::PoseObserver observer);

  /// Maps the next scan. Returns false at the end of the log and where the log is damaged (see broken_off()).
  /// Throws UserError if the log is damaged before its first scan.
  bool step();

  /// Returns whether step() would not wait for a scan. Always true for a log that is read in this thread.
  bool scan_waits() const;

  /// Damage of the log after its last readable scan, as a sentence. Empty if there is none.
  const std::optional<std::string>& broken_off() const;
  /// Returns whether the current log or an earlier log of the session is damaged.
  bool breaks_off() const;
  /// Warnings about the logs before the current one, one sentence each: damage, or scans that were not read.
  std::vector<std::string> warnings_of_logs_before() const;
  /// Messages and scans that were skipped in all logs read so far.
  SkippedLines skipped_lines() const;

  /// Adds planned edits to the edits of the input. Each edit is made after the scan that it names. Call
  /// before the first step(). Throws UserError, and adds nothing, if zones or known places contradict each
  /// other or the settings.
  void add_edits(const EditJournal& edits);
  /// Changes a loop by hand now. An edit after finish() needs stay_open() and reopens the map: call finish()
  /// again.
  LoopEditOutcome edit(const LoopEdit& edit);
  /// Adds an edit of the drawn map, after all edits of the drawn map so far. The next export_to() makes it.
  /// Does not reopen a finished map. Throws UserError, and adds nothing, if zones contradict each other.
  void edit(const MapEdit& edit);
  /// Removes the last edit of the drawn map, if there is one.
  void remove_last_map_edit();
  /// Restores planned edits that a later edit removed from the journal. Makes edits whose time has passed at
  /// once.
  void plan(const std::vector<TimedEdit>& edits);
  /// All edits, made and planned. Equal logs, settings and edits give equal maps.
  const EditJournal& edits() const;
  /// Edits that could not be made, one sentence each. The list is complete after finish(), and for edits of
  /// the drawn map after export_to().
  std::vector<std::string> unmet_edits() const;

  /// What the reader assumed because the log does not state it, such as the mount of a laser, and scans
  /// without odometry; one sentence each.
  std::vector<std::string> assumptions() const;

  /// Faults of odometry, laser and time stamps that a quick check of the log found, one sentence each with
  /// its remedy. Empty before finish(). The first of export_to(), draw(), warnings() and this function after
  /// finish() makes the check, so do not call it from two threads.
  const std::vector<std::string>& faults_of_log() const;

  /// All warnings about this run, one sentence each: renamed settings, damaged logs, skipped messages,
  /// assumptions(), faults_of_log() and edits that could not be made. After finish(), also scans that matched
  /// no local map, and known poses that contradict the scans.
  std::vector<std::string> warnings() const;

  /// Number of runs through the building: this run and the runs merged before it.
  std::size_t runs() const;

  /// Keeps the mapper after finish(), so that edits, reopen() and begin_run() remain possible. Needs the
  /// memory of a second graph.
  void stay_open();
  /// Returns whether finish() was called and not undone by reopen(), edit() or begin_run().
  bool finished() const;
  /// Undoes finish(). Needs stay_open(). Call finish() again afterwards.
  void reopen();

  /// Ends the mapping and makes result(). If `stop` becomes true, cuts the search in the prior map and the
  /// final search short. Sets result().interrupted then, and if readable scans of the log were left unread.
  /// Throws UserError if no scan has a return.
  void finish(const std::atomic<bool>& stop);
  /// Ends the mapping like finish(stop), with a final search that cannot be cut short.
  void finish();

  /// Maps at least one scan, continues to the end of the log or until `stop` is true, then calls finish().
  /// Meanwhile, with several threads and without a pose observer, loops correct the poses of mapper() as soon
  /// as they are found, see Mapper::run_ahead().
  void run(const std::atomic<bool>& stop);

  /// Continues the finished map with another run through the same building, which begins at `start` (see
  /// place_run()). Needs stay_open(). Call finish() again after the last scan. Throws UserError if the run's
  /// log is unreadable.
  void begin_run(const SessionInput& run, const RunStart& start);

  /// Draws the map and writes all results. Needs finish(); may be called for several folders. Returns the
  /// figures of summary.json and report.html; their times exclude the writing of these two files. Throws
  /// SystemFailure if a file cannot be written.
  RunSummary export_to(const OutputFolder& folder);
  /// Creates the folder and exports to it. Throws UserError if it is not empty, unless `force` is true.
  void export_to(const std::filesystem::path& folder, bool force = false);

  /// Draws and judges the map as export_to() does, but writes no file. Needs finish(). The definition of
  /// DrawnMap is internal.
  DrawnMap draw();
  /// Calls `read` with the finished map, with its poses in the frame in which export_to() writes them. Needs
  /// finish().
  void read_exported(const std::function<void(const MappingResult&)>& read);

  /// Records the session in a journal from now on, so that a crash or a power failure loses only the
  /// scans of the last moments. A journal is read like a session. Its file replaces an existing one; a
  /// recording that is resumed is copied to it first. Call before the first step(). Throws SystemFailure if
  /// the file cannot be created. The destructor keeps the file.
  void start_journal(const std::filesystem::path& file);
  /// Ends the journal, if there is one, and deletes its file, unless a saved session has replaced it.
  void remove_journal();
  /// Returns why the journal could not be written the last time, as a sentence without full stop. Empty if it
  /// was written. Writing is tried again until it works, so that the journal becomes complete.
  std::optional<std::string> journal_failure() const;

  /// Writes the mapped scans, all edits and settings to a session file. If only a part of a recorded session
  /// was mapped again, still writes all its recorded scans. Throws SystemFailure if the file cannot be
  /// written.
  SavedSession save(const std::filesystem::path& file) const;

  /// Mapper with the poses, graph and loops so far. Valid until finish(); with stay_open() also afterwards.
  const Mapper& mapper() const;

  /// The finished map. Needs finish().
  const MappingResult& result() const;

  /// Program, log and settings, for the summary and the report.
  RunInfo run_info() const;

 private:
  DrawnMap draw_and_write(const OutputFolder* folder);

  struct Members;
  std::unique_ptr<Members> m_;
};

}  // namespace psi_slam
