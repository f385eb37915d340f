// SPDX-License-Identifier: BSD-3-Clause
// Opening logs and sessions in the window.
#include <wx/simplebook.h>

#include <new>

#include "loop_inspector.h"
#include "main_frame.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "plot_panel.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"
#include "settings_panel.h"
#include "wx_text.h"

namespace psi_slam {

void MainFrame::start(const std::string& log, const std::string& config,
                      const std::vector<std::string>& settings, const std::string& edits) {
  std::optional<EditJournal> journal;
  attempt([&] {
    settings_.load(config, settings);
    if (!edits.empty()) journal = EditJournal::read(edits);
  });
  settings_panel_->refresh();
  if (log.empty()) return;
  open_log(log, std::move(journal), [=](BoundSettings& bound) { bound.load(config, settings); });
}

void MainFrame::open_log(const std::filesystem::path& log, std::optional<EditJournal> edits,
                         const std::function<void(BoundSettings&)>& overrule) {
  const auto open_input = [=](SessionInput input, const std::vector<std::string>& remarks) {
    opened_ = log;
    open(edits ? input.with_edits(*edits) : std::move(input), Edits::kOfFile);
    if (!remarks.empty()) messages_->warn(first_sentences(remarks));
  };
  attempt([&] {
    if (!is_session_file(log)) {
      session_settings_.clear();
      return open_input(SessionInput(log), {});
    }
    const int edits_before = replay_ ? replay_->edits_asked() : 0;
    read_session(
        log, [log] { return SessionInput::of_file(log); },
        [=](const SessionInput& input) {
          const auto open_session = [=] {
            open_input(input, take_settings_of(input.recording()->facts, log, overrule));
          };
          if (!replay_ || replay_->edits_asked() == edits_before) return open_session();
          messages_->warn("Loops were edited while " + log.string() + " was read. Open it anyway?",
                          {{"Open it", [=] { attempt(open_session); }}});
        });
  });
}

void MainFrame::read_session(const std::filesystem::path& file, SessionReader::Read read,
                             SessionReader::Take take) {
  messages_->note("Reading " + file.string());
  session_reader_.begin(std::move(read), std::move(take));
}

/// Takes over the settings of a session, all or none. Returns remarks for the user.
std::vector<std::string> MainFrame::take_settings_of(const SessionFacts& facts,
                                                     const std::filesystem::path& file,
                                                     const std::function<void(BoundSettings&)>& overrule) {
  BoundSettings recorded;  // options that the session does not set have their defaults
  std::vector<std::string> remarks = load_recorded(recorded, facts, file);
  if (const auto other = other_version_text(file, facts)) remarks.push_back(*other);
  std::map<std::string, std::string> kept = kept_settings(recorded.table);
  if (overrule) overrule(recorded);
  require_kept(kept, recorded.table, file);
  session_settings_ = std::move(kept);
  settings_.settings = recorded.settings;
  settings_panel_->refresh();
  return remarks;
}

void MainFrame::resume_with(const std::filesystem::path& log) {
  if (!replay_ || !replay_->input().recording()) return;
  attempt([&] {
    read_session(
        log, [recording = replay_->input().recording(), log] { return SessionInput(recording, log); },
        [this](const SessionInput& input) { open(input.with_edits(edits()), Edits::kMadeSoFar); });
  });
}

void MainFrame::attempt(const std::function<void()>& action) {
  try {
    action();
  } catch (...) {
    report_failure(std::current_exception());
  }
}

void MainFrame::report_failure(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    messages_->fail("Out of memory: close other programs or map a shorter log");
  } catch (const std::exception& error) {
    messages_->fail(error.what());
  }
}

void MainFrame::open(SessionInput input, Edits edits) {
  if (input.recording()) require_kept(session_settings_, settings_.table, opened_);
  session_reader_.give_up();  // its session was to continue the previous run
  messages_->dismiss();
  run_ = {};
  set_adding_loop(false);
  loops_->show_nothing();
  plots_->show_nothing();
  run_.settings = settings_file_text(settings_.table);
  settings_panel_->show_pending(false);
  edits == Edits::kOfFile ? unsaved_.open(input) : unsaved_.restart(input);
  replay_.open(std::move(input), settings_.settings);
  replay_->set_speed(speed_);
  middle_->SetSelection(kMapPage);
  canvas_->show_all();
  SetTitle(text_of(opened_.filename()) + wxString::FromUTF8(" — psi-slam"));
  refresh();
}

void MainFrame::open_other_log(const std::filesystem::path& log) {
  if (!has_unsaved_edits()) return open_log(log);
  messages_->warn("Loop edits have not been saved. Open another log anyway?",
                  {{"Open it", [this, log] { open_log(log); }}});
}

void MainFrame::show_pending_settings() {
  if (replay_) settings_panel_->show_pending(settings_file_text(settings_.table) != run_.settings);
}

void MainFrame::restart() {
  if (replay_) attempt([this] { open(replay_->input().with_edits(edits()), Edits::kMadeSoFar); });
}

}  // namespace psi_slam
