// SPDX-License-Identifier: BSD-3-Clause
#include "map_command.h"

#include <exception>
#include <memory>
#include <ostream>

#include "base/exit_code.h"
#include "closing_text.h"
#include "exports/run_summary.h"
#include "psi_slam/user_error.h"
#include "report/output_folder.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"

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
    if (is_session_file(line.log))
      throw UserError(line.log + " is a session, not a log: psi-slam --resume " + line.log + " -o DIR");
    load_settings(line, bound);
    return SessionInput(line.log);
  }
  const auto recording = std::make_shared<const SessionRecording>(read_session_file(line.resume));
  load_recorded_settings(line, line.resume, recording->facts, bound, streams);
  const auto kept = kept_settings(bound.table);
  load_settings(line, bound);
  require_kept(kept, bound.table, line.resume);
  return SessionInput(recording, line.log);
}

struct SavingOutcome {
  std::exception_ptr failure;  ///< the map is to be written nevertheless
  std::string remark;          ///< what the session lacks
  bool is_whole() const { return !failure && remark.empty(); }
};

SavingOutcome save_session(const MappingSession& session, const std::string& file) {
  try {
    return {nullptr, session.save(file).remark};
  } catch (...) {
    return {std::current_exception(), ""};
  }
}

void tell_result(const MappingSession& session, const RunSummary& summary, const OutputFolder& folder,
                 const CommandLine& line, const Streams& streams, bool saved) {
  const RunInfo info = session.run_info();
  if (line.verbose) streams.err << stages_text(session.result());
  if (line.json)
    streams.out << summary_json(session.result(), info, summary);
  else if (!line.quiet)
    streams.out << closing_text(summary, info.log_name, folder);
  if (saved && !line.json && !line.quiet)
    streams.out << "The session is " << line.save_session << ": --resume goes on with it.\n";
}

}  // namespace

void check_session_to_save(const CommandLine& line) {
  namespace fs = std::filesystem;
  if (line.save_session.empty()) return;
  const fs::path file = line.save_session;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw UserError("--save-session " + file.string() + ": it is a folder");
  if (!fs::is_directory(folder, ignored))
    throw UserError("--save-session " + file.string() + ": there is no folder " + folder.string());
  const bool resumed = !line.resume.empty() && fs::equivalent(file, line.resume, ignored);
  if (fs::exists(file, ignored) && !line.force && !resumed)
    throw UserError("--save-session " + file.string() + ": it is there already, give --force to replace it");
}

void load_recorded_settings(const CommandLine& line, const std::string& file, const SessionFacts& facts,
                            BoundSettings& bound, const Streams& streams) {
  for (const std::string& sentence : load_recorded(bound, facts, file))
    streams.err << "psi-slam: " << sentence << '\n';
  if (const auto other = other_version_text(file, facts); other && !line.quiet)
    streams.err << "psi-slam: " << *other << '\n';
}

void watch(MappingSession& session, const InterruptSignals& signals, const CommandLine& line,
           const Streams& streams, std::optional<ProgressLine>& progress_line) {
  if (streams.err_is_terminal && !line.quiet) progress_line.emplace(streams.err);
  session.set_observer([&, told = false](const SessionProgress& progress) mutable {
    if (!told && progress.phase == SessionProgress::Phase::kFinalSearch && signals.came()) {
      told = true;
      if (progress_line) progress_line->clear();
      streams.err << "psi-slam: " << interrupted_text(progress.scans) << '\n';
    }
    if (progress_line) progress_line->show(progress);
  });
}

int save_and_export(MappingSession& session, const OutputFolder& folder, const CommandLine& line,
                    const Streams& streams, std::optional<ProgressLine>& progress_line) {
  const bool to_save = !line.save_session.empty();
  const SavingOutcome saved = to_save ? save_session(session, line.save_session) : SavingOutcome();
  const RunSummary summary = session.export_to(folder);
  progress_line.reset();
  session.set_observer({});
  tell_result(session, summary, folder, line, streams, to_save && saved.is_whole());
  if (!saved.remark.empty()) streams.err << "psi-slam: " << saved.remark << '\n';
  if (const SkippedLines skipped = session.skipped_lines(); skipped.count > 0 && !session.broken_off())
    streams.err << "psi-slam: " << skipped.sentence() << '\n';
  for (const std::string& unmet : session.unmet_edits())
    streams.err << "psi-slam: an edit was not made: " << unmet << '\n';
  if (const auto coarser = coarser_cells_text(summary.map)) streams.err << "psi-slam: " << *coarser << '\n';
  for (const std::string& warning : session.warnings_of_logs_before())
    streams.err << "psi-slam: " << warning << '\n';
  if (session.broken_off())
    streams.err << "psi-slam: " << broken_off_text(*session.broken_off(), session.result().frames.size())
                << '\n';
  if (saved.failure) std::rethrow_exception(saved.failure);
  return session.breaks_off() ? kExitWrongUsageOrInput : kExitDone;
}

int map_log(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  const SessionInput input = input_of(line, bound, streams);
  if (line.verbose) streams.err << changed_settings(bound.table);
  const InterruptSignals signals;
  MappingSession session(input, bound.settings);
  if (!line.edits.empty()) session.add_edits(EditJournal::read(line.edits));
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  check_session_to_save(line);
  std::optional<ProgressLine> progress_line;
  watch(session, signals, line, streams, progress_line);
  session.run(signals.came());
  return save_and_export(session, folder, line, streams, progress_line);
}

}  // namespace psi_slam
