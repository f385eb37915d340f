// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/exit_code.h"
#include "base/failure_notice.h"
#include "batch/kept_run.h"
#include "closing_text.h"
#include "commands.h"
#include "files_to_write.h"
#include "logs/doctor/input_doctor.h"
#include "map/exports/frozen_odometry.h"
#include "map/exports/interruptions.h"
#include "map/exports/run_summary.h"
#include "map/exports/unmatched_scans.h"
#include "map/report/output_folder.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/user_error.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/session_prior.h"
#include "site_run.h"

namespace psi_slam {
namespace {

std::string changed_settings(const OptionTable& table) {
  std::string lines;
  for (const OptionSection& section : table.sections())
    for (const Option& option : section.options)
      if (option.text() != option.default_text) lines += option.name() + " = " + option.text() + '\n';
  return lines;
}

SessionInput input_of(const CommandLine& line, BoundSettings& bound, const Streams& streams) {
  if (line.resume.empty()) {
    require_log(line.log);
    load_settings(line, bound, streams);
    return SessionInput(line.log);
  }
  return SessionInput(read_resumed(line, bound, streams), line.log);
}

void print_result(const MappingSession& session, const RunSummary& summary, const OutputFolder& folder,
                  const CommandLine& line, const Streams& streams, bool saved) {
  const RunInfo info = session.run_info();
  if (line.verbose) streams.err << stages_text(session.result());
  if (line.json)
    streams.out << summary_json(session.result(), info, summary);
  else if (!line.quiet)
    streams.out << closing_text(summary, info.log_name, folder);
  if (saved && !line.json && !line.quiet)
    streams.out << "The session is saved as " << line.save_session << ". Resume it with --resume.\n";
}

/// Returns the diagnosis of a log. Throws UserError with the verdict if the log cannot be mapped.
LogDiagnosis diagnosis_of(const std::filesystem::path& log, const LogOptions& options) {
  try {
    return diagnose(log, options);
  } catch (const UserError& error) {
    throw UserError("verdict: cannot be mapped: " + std::string(error.what()));
  }
}

/// Writes the results. If that fails, too, the exception names both failures.
RunSummary export_after(const std::string& failure, MappingSession& session, const OutputFolder& folder) {
  try {
    return session.export_to(folder);
  } catch (const std::exception& error) {
    if (failure.empty()) throw;
    throw SystemFailure(failure + ", and the results are not written: " + error.what());
  }
}

}  // namespace

void warn_of_lost_end(const SessionRecording& recording, const Streams& streams) {
  if (recording.lost_end) streams.err << "psi-slam: " << *recording.lost_end << '\n';
}

void load_recorded_settings(const CommandLine& line, const std::string& file, const SessionFacts& facts,
                            BoundSettings& bound, const Streams& streams) {
  for (const std::string& sentence : load_recorded(bound, facts, file))
    streams.err << "psi-slam: " << sentence << '\n';
  if (const auto other = other_version_text(file, facts); other && !line.quiet)
    streams.err << "psi-slam: " << *other << '\n';
}

std::shared_ptr<const SessionRecording> read_resumed(const CommandLine& line, BoundSettings& bound,
                                                     const Streams& streams) {
  auto recording = std::make_shared<const SessionRecording>(read_session_file(line.resume));
  warn_of_lost_end(*recording, streams);
  load_recorded_settings(line, line.resume, recording->facts, bound, streams);
  const auto kept = kept_settings(bound.table);
  load_settings(line, bound, streams);
  require_kept(kept, bound.table, line.resume);
  return recording;
}

void calibrate(SessionInput& input, const Settings& settings, const CommandLine& line,
               const InterruptSignals& signals, const Streams& streams) {
  check(settings);
  WorkProgress progress(streams.err_is_terminal && !line.quiet ? &streams.err : nullptr);
  const std::string log = input.logs().back().name;
  try {
    input.calibrate(log_options(settings), [&](double share) {
      if (signals.came())
        throw SystemFailure("interrupted before " + log + " was calibrated. Nothing was written");
      if (settings.log.calibrate) progress.show("calibrating " + log, share, 1);
    });
  } catch (const SystemFailure&) {
    if (settings.log.calibrate) throw;  // otherwise, mapping tells
  }
}

void watch(MappingSession& session, const InterruptSignals& signals, const CommandLine& line,
           const Streams& streams, std::optional<ProgressLine>& progress_line) {
  if (streams.err_is_terminal && !line.quiet) progress_line.emplace(streams.err);
  const auto print = [&](const std::string& sentence) {
    if (progress_line) progress_line->clear();
    streams.err << "psi-slam: " << sentence << '\n';
  };
  session.set_observer([&, print, reported = false,
                        journal = FailureNotice("the journal")](const SessionProgress& progress) mutable {
    const bool finishes = progress.phase == SessionProgress::Phase::kPriorSearch ||
                          progress.phase == SessionProgress::Phase::kFinalSearch;
    if (!reported && finishes && signals.came()) {
      reported = true;
      print(interrupted_text(progress.scans));
    }
    if (const auto news = journal.news(session.journal_failure())) print(*news);
    if (progress_line) progress_line->show(progress);
  });
}

int save_and_export(MappingSession& session, const OutputFolder& folder, const CommandLine& line,
                    const Streams& streams, std::optional<ProgressLine>& progress_line,
                    const std::function<void(const RunSummary&)>& exported) {
  const bool to_save = !line.save_session.empty();
  SavedSession saved;
  std::string failure;  // to save the session; the results are written anyway
  try {
    if (to_save) saved = session.save(line.save_session);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  const RunSummary summary = export_after(failure, session, folder);
  progress_line.reset();
  session.set_observer({});
  if (exported) exported(summary);
  print_result(session, summary, folder, line, streams, to_save && failure.empty() && saved.remark.empty());
  const auto warn = [&](const std::string& sentence) { streams.err << "psi-slam: " << sentence << '\n'; };
  if (!saved.remark.empty()) warn(saved.remark);
  if (const SkippedLines skipped = session.skipped_lines(); skipped.count > 0 && !session.broken_off())
    warn(skipped.sentence());
  for (const std::string& assumption : session.assumptions()) warn(assumption);
  for (const std::string& fault : session.faults_of_log()) warn(fault);
  for (const std::string& unmet : session.unmet_edits()) warn("an edit was not made: " + unmet);
  for (const std::string& sentence : session.result().contradictions) warn(sentence);
  if (const auto coarser = coarser_cells_text(summary.map)) warn(*coarser);
  const MapVerdict* verdict = summary.verdict ? &*summary.verdict : nullptr;
  if (const auto unmatched = unmatched_scans_text(session.result(), verdict)) warn(*unmatched);
  if (const auto frozen = frozen_odometry_text(session.result())) warn(*frozen);
  for (const std::string& interruption : interruption_texts(session.result())) warn(interruption);
  if (const auto broken = broken_map_text(summary)) warn(*broken);
  for (const std::string& warning : session.warnings_of_logs_before()) warn(warning);
  if (session.broken_off()) warn(broken_off_text(*session.broken_off(), session.result().frames.size()));
  if (!failure.empty()) throw SystemFailure(failure);
  const bool is_of_site = add_to_site(line, session, summary, folder, streams);
  session.remove_journal();
  return session.breaks_off() || !is_of_site ? kExitWrongUsageOrInput : kExitDone;
}

int map_log(const CommandLine& given, const Streams& streams) {
  CommandLine line = given;
  continue_site(line, run_name(line));
  BoundSettings bound;
  SessionInput input = input_of(line, bound, streams);
  if (line.output.empty()) {
    line.output = default_output_folder(line);
    streams.err << "psi-slam: the results go to the folder " << line.output << ". Name another one with -o\n";
  }
  const InterruptSignals signals;
  if (line.verbose) streams.err << changed_settings(bound.table);
  EditJournal edits;
  if (!line.edits.empty()) edits = EditJournal::read(line.edits);
  OutputFolder::check(line.output, line.force);
  check_prior_apart(bound.settings, line.output);
  check_files_to_write(line);
  calibrate(input, bound.settings, line, signals, streams);
  MappingSession session(input, bound.settings);
  if (!line.edits.empty()) session.add_edits(edits);
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  if (!line.journal.empty()) session.start_journal(line.journal);
  std::optional<ProgressLine> progress_line;
  watch(session, signals, line, streams, progress_line);
  session.run(signals.came());
  return save_and_export(session, folder, line, streams, progress_line);
}

int check_log(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  const LogDiagnosis diagnosis = diagnosis_of(line.log, log_options(bound.settings));
  if (line.json)
    streams.out << json_file_text(to_json(diagnosis));
  else
    for (const std::string& sentence : describe(diagnosis)) streams.out << sentence << '\n';
  const std::string refusal = refusal_of(diagnosis);
  if (refusal.empty()) return kExitDone;
  streams.err << "psi-slam: " << refusal << '\n';
  return kExitWrongUsageOrInput;
}

}  // namespace psi_slam
