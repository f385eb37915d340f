// SPDX-License-Identifier: BSD-3-Clause
// How the window opens logs and sessions.
#include <wx/simplebook.h>

#include <new>

#include "first_sentences.h"
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
  telling_failures([&] {
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
    if (!remarks.empty()) messages_->say(MessageBar::Kind::kWarning, first_sentences(remarks));
  };
  telling_failures([&] {
    if (!is_session_file(log)) {
      kept_settings_.clear();
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
          messages_->say(MessageBar::Kind::kWarning,
                         "Loops were edited while " + log.string() + " was read. Open it nevertheless?",
                         {{"Open it", [=] { telling_failures(open_session); }}});
        });
  });
}

void MainFrame::read_session(const std::filesystem::path& file, SessionReader::Read read,
                             SessionReader::Take take) {
  messages_->say(MessageBar::Kind::kNote, "Reading " + file.string());
  session_reader_.begin(std::move(read), std::move(take));
}

/// All or none of them; returns what the user is to know of them.
std::vector<std::string> MainFrame::take_settings_of(const SessionFacts& facts,
                                                     const std::filesystem::path& file,
                                                     const std::function<void(BoundSettings&)>& overrule) {
  BoundSettings recorded;  // what the session does not set has its default
  std::vector<std::string> remarks = load_recorded(recorded, facts, file);
  if (const auto other = other_version_text(file, facts)) remarks.push_back(*other);
  std::map<std::string, std::string> kept = kept_settings(recorded.table);
  if (overrule) overrule(recorded);
  require_kept(kept, recorded.table, file);
  kept_settings_ = std::move(kept);
  settings_.settings = recorded.settings;
  settings_panel_->refresh();
  return remarks;
}

void MainFrame::go_on_with(const std::filesystem::path& log) {
  if (!replay_ || !replay_->input().recording()) return;
  telling_failures([&] {
    read_session(
        log, [recording = replay_->input().recording(), log] { return SessionInput(recording, log); },
        [this](const SessionInput& input) { open(input.with_edits(edits()), Edits::kMadeSoFar); });
  });
}

void MainFrame::telling_failures(const std::function<void()>& action) {
  try {
    action();
  } catch (...) {
    tell_failure(std::current_exception());
  }
}

void MainFrame::tell_failure(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const std::bad_alloc&) {
    messages_->say(MessageBar::Kind::kError, "There is not enough memory for that");
  } catch (const std::exception& error) {
    messages_->say(MessageBar::Kind::kError, error.what());
  }
}

void MainFrame::open(SessionInput input, Edits edits) {
  if (input.recording()) require_kept(kept_settings_, settings_.table, opened_);
  session_reader_.give_up();  // what is being read was for the run before
  messages_->dismiss();
  snapshot_.reset();
  shown_frame_.reset();
  told_failure_.clear();
  told_warnings_.clear();
  told_export_ = 0;
  told_save_ = 0;
  told_edit_ = 0;
  set_adding_loop(false);
  remembered_ = false;
  close_when_written_ = false;
  closes_without_export_ = false;
  loops_->show_nothing();
  plots_->show_nothing();
  settings_of_run_ = settings_file_text(settings_.table);
  settings_panel_->show_pending(false);
  edits == Edits::kOfFile ? unsaved_.open(input) : unsaved_.begin_again(input);
  replay_.open(std::move(input), settings_.settings);
  replay_->set_speed(speed_);
  middle_->SetSelection(kMapPage);
  canvas_->show_all();
  SetTitle(text_of(opened_.filename()) + wxString::FromUTF8(" — psi-slam"));
  refresh();
}

void MainFrame::open_other_log(const std::filesystem::path& log) {
  if (!has_unsaved_edits()) return open_log(log);
  messages_->say(MessageBar::Kind::kWarning,
                 "Loops edited by hand have not been saved. Open another log nevertheless?",
                 {{"Open it", [this, log] { open_log(log); }}});
}

void MainFrame::show_pending_settings() {
  if (replay_) settings_panel_->show_pending(settings_file_text(settings_.table) != settings_of_run_);
}

void MainFrame::restart() {
  if (replay_) telling_failures([this] { open(replay_->input().with_edits(edits()), Edits::kMadeSoFar); });
}

}  // namespace psi_slam
