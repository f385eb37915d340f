// SPDX-License-Identifier: BSD-3-Clause
// The window: the map in the middle with the transport below it, settings on the right, plots and loops
// below. It looks at the run twenty times a second and never waits for it.
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/filehistory.h>
#include <wx/frame.h>
#include <wx/timer.h>

#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file_questions.h"
#include "session/settings.h"
#include "replay_slot.h"
#include "session_reader.h"
#include "unsaved_work.h"
#include "window_layout.h"

class wxSimplebook;

namespace psi_slam {

class LoopInspector;
class MapCanvas;
class MessageBar;
class PlotPanel;
class SettingsPanel;
class TransportBar;

class MainFrame : public wxFrame {
 public:
  MainFrame();
  ~MainFrame() override;

  /// What the command line asks for; empty names ask for nothing.
  void start(const std::string& log, const std::string& config, const std::vector<std::string>& settings,
             const std::string& edits = "");

  /// A log, or a session, whose settings become those of the window. `edits` are made while it is mapped, if
  /// there are any instead of the session's; `overrule` changes settings of a session that may be changed.
  void open_log(const std::filesystem::path& log, std::optional<EditJournal> edits = {},
                const std::function<void(BoundSettings&)>& overrule = {});
  /// The same, but where edits would be lost the user is asked first.
  void open_other_log(const std::filesystem::path& log);
  void open_settings(const std::filesystem::path& file);
  void save_settings(const std::filesystem::path& file);
  void export_to(const std::filesystem::path& folder, bool replace);
  void save_picture(const std::filesystem::path& file);
  /// The log is mapped again with the edits of a file; where others would be lost the user is asked first.
  void open_edits(const std::filesystem::path& file);
  void save_edits(const std::filesystem::path& file);
  /// Maps behind the session that is open what a log holds beyond it.
  void go_on_with(const std::filesystem::path& log);
  /// Once the engine comes to it: between two scans, or after the last pass.
  void save_session(const std::filesystem::path& file);
  /// In the bar: what went wrong, as a sentence.
  void tell_failure(const std::exception_ptr& failure);
  /// Shows a scan that was mapped already, or maps up to it.
  void go_to(std::size_t scan);

  // For those who drive the window.
  void set_ask_for_file(AskForFile ask) { ask_for_file_ = std::move(ask); }
  wxAuiManager& panes() { return panes_; }
  const ReplaySlot& replay() const { return replay_; }
  BoundSettings& settings() { return settings_; }
  MapCanvas& map() { return *canvas_; }
  MessageBar& messages() { return *messages_; }
  LoopInspector& loops() { return *loops_; }
  SettingsPanel& settings_panel() { return *settings_panel_; }

 private:
  void build();
  wxWindow* build_middle();
  void build_toolbar();
  void bind_commands();
  void bind_file_commands();
  void bind_view_commands();
  void bind_edit_commands();
  void on(int command, const std::function<void()>& action);

  void press_key(wxKeyEvent& event);

  void refresh();
  void take_news(const ReplaySnapshot& snapshot);
  void take_edit_news(const ReplaySnapshot& snapshot);
  void enable_commands(const ReplaySnapshot* snapshot);
  void enable_edit_commands(const ReplaySnapshot* snapshot);
  void close(wxCloseEvent& event);
  bool has_unsaved_work() const;
  bool has_unsaved_edits() const;
  /// An edit that was asked for has not been made yet: what is read of the run would lack it.
  bool edits_are_under_way() const;
  void tell_warnings(const std::vector<std::string>& warnings);
  void tell_export(const ExportOutcome& outcome);
  void tell_save(const SaveOutcome& outcome);

  void ask_for_log();
  void ask_for_log_folder();
  void ask_for_settings(bool save);
  void ask_for_export();
  void ask_for_picture();
  void ask_for_session();
  void ask_for_log_of_session();
  /// Once `read` has given a session, in another thread, `take` is called in this one.
  void read_session(const std::filesystem::path& file, SessionReader::Read read, SessionReader::Take take);
  std::vector<std::string> take_settings_of(const SessionFacts& facts, const std::filesystem::path& file,
                                            const std::function<void(BoundSettings&)>& overrule);
  enum class Edits { kOfFile, kMadeSoFar };
  /// Throws UserError where it is a recording and the settings are not its own.
  void open(SessionInput input, Edits edits);
  /// What `action` throws is a sentence in the bar.
  void telling_failures(const std::function<void()>& action);
  /// Menus and tools say what is shown.
  void check_choices();
  void play_or_pause();
  void step();
  void finish();
  void restart();
  /// Whether the settings are other than those of the run under way.
  void show_pending_settings();
  void set_speed(double speed);
  void choose_loop(std::optional<std::size_t> loop);
  void edit_selected(LoopEdit::Kind kind, MatcherKind matcher = MatcherKind::kCsm);
  void toggle_adding_loop();
  void set_adding_loop(bool on);
  void point_at(const mrpt::math::TPoint2D& place);
  void map_again_with(const std::filesystem::path& edits);
  /// All that were made. Throws UserError while one is under way.
  EditJournal edits() const;
  void toggle_pane(wxWindow* window, bool shown);
  void remember(const std::filesystem::path& log);
  void tell(const std::string& text);  ///< in the status bar

  BoundSettings settings_;
  ReplaySlot replay_;
  SessionReader session_reader_;
  UnsavedWork unsaved_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<std::size_t> shown_frame_;  ///< looked at instead of the newest
  double speed_ = 0;
  std::string settings_of_run_;                       ///< as text: to see whether they have changed since
  std::filesystem::path opened_;                      ///< log or session
  std::map<std::string, std::string> kept_settings_;  ///< of a session: it cannot be mapped with others
  std::string told_failure_;                          ///< what was said of this run already
  std::vector<std::string> told_warnings_;
  int told_export_ = 0;
  int told_save_ = 0;
  int told_edit_ = 0;
  std::optional<mrpt::math::TPoint2D> first_place_;  ///< pointed at, of a loop to be added
  bool remembered_ = false;                          // among the recent logs
  bool closes_without_export_ = false;
  bool close_when_written_ = false;

  AskForFile ask_for_file_;
  wxAuiManager panes_;
  std::optional<WindowLayout> layout_;
  wxFileHistory recent_;
  wxTimer timer_;
  static constexpr int kMapPage = 1;  // of middle_; page 0 says what to do without a log
  wxSimplebook* middle_ = nullptr;
  MessageBar* messages_ = nullptr;
  MapCanvas* canvas_ = nullptr;
  TransportBar* transport_ = nullptr;
  SettingsPanel* settings_panel_ = nullptr;
  LoopInspector* loops_ = nullptr;
  PlotPanel* plots_ = nullptr;
};

}  // namespace psi_slam
