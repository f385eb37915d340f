// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/filehistory.h>
#include <wx/frame.h>
#include <wx/timer.h>

#include <array>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "live/live_source.h"
#include "replay_slot.h"
#include "session/settings.h"
#include "session_reader.h"
#include "speed_dialog.h"
#include "unsaved_work.h"

class wxSimplebook;

namespace psi_slam {

class LoopInspector;
class MapCanvas;
class MessageBar;
class PlotPanel;
class SettingsPanel;
class TransportBar;

struct FileQuestion {
  enum class Kind { kOpen, kSave, kFolder };
  Kind kind = Kind::kOpen;
  std::string title;
  std::string wildcard;  ///< file types, as wxFileDialog takes them
  std::string proposed_name;
};

/// Asks the user for a file or folder. Returns its path, or nothing if the user cancels. If a file to save
/// exists, the user has agreed to replace it.
using AskForFile = std::function<std::optional<std::filesystem::path>(const FileQuestion&)>;

/// Asks the user for the number of a TCP port. Returns nothing if the user cancels.
using AskForPort = std::function<std::optional<std::uint16_t>()>;

/// Asks the user for the largest speed in a zone, and proposes one. Returns nothing if the user cancels.
using AskForSpeed = std::function<std::optional<SpeedLimit>(const SpeedLimit& proposed)>;

/// The window. The map is in the middle, with the transport bar and the loops below it, and settings and
/// plots on its right. The window reads the state of the run 20 times a second and never waits for the run.
class MainFrame : public wxFrame {
 public:
  MainFrame();

  /// Loads the settings and opens the files that the command line names. Ignores empty names.
  void start(const std::string& log, const std::string& config, const std::vector<std::string>& settings,
             const std::string& edits = "");

  /// Opens a log or a session. A session also replaces the window's settings. `edits`, if given, replace the
  /// session's edits. `overrule` may change settings that do not shape the map of the session.
  void open_log(const std::filesystem::path& log, const std::optional<EditJournal>& edits = {},
                const std::function<void(BoundSettings&)>& overrule = {});
  /// Calls open_log(), but asks first if edits or a live map would be lost.
  void open_other_log(const std::filesystem::path& log);
  /// Maps what a live source sends, and records it in the file `journal` unless that path is empty.
  void connect(const LiveInput& source, const std::filesystem::path& journal);
  /// Asks for the journal and calls connect(). Asks first if edits or another live map would be lost.
  void connect_other(const LiveInput& source);
  /// Opens a file that was dropped on the window: settings, edits, a log or a session.
  void open_dropped(const std::filesystem::path& file);
  void open_settings(const std::filesystem::path& file);
  void save_settings(const std::filesystem::path& file);
  void export_to(const std::filesystem::path& folder, bool replace);
  void save_picture(const std::filesystem::path& file);
  /// Maps the log again with the edits of a file. Asks first if edits would be lost.
  void open_edits(const std::filesystem::path& file);
  void save_edits(const std::filesystem::path& file);
  /// Continues the open session with a log: its own last log, or a log that continues it.
  void resume_with(const std::filesystem::path& log);
  /// Saves the session after the present scan, or after the final loop search.
  void save_session(const std::filesystem::path& file);
  /// Shows the message of an exception in the message bar.
  void report_failure(const std::exception_ptr& failure);
  /// Shows the scan with number `scan`, counted from 0, if it is mapped. Otherwise maps up to this scan.
  void go_to(std::size_t scan);

  // Access for tests.
  void set_ask_for_file(AskForFile ask) { ask_for_file_ = std::move(ask); }
  void set_ask_for_port(AskForPort ask) { ask_for_port_ = std::move(ask); }
  void set_ask_for_speed(AskForSpeed ask) { ask_for_speed_ = std::move(ask); }
  wxAuiManager& panes() { return panes_; }
  const ReplaySlot& replay() const { return replay_; }
  BoundSettings& settings() { return settings_; }
  MapCanvas& map() { return *canvas_; }
  MessageBar& messages() { return *messages_; }
  LoopInspector& loops() { return *loops_; }
  SettingsPanel& settings_panel() { return *settings_panel_; }

 private:
  /// State of the window that belongs to one run; reset when another run is opened.
  struct RunState {
    std::shared_ptr<const ReplaySnapshot> snapshot;
    std::optional<std::size_t> frame;  ///< an earlier scan to show instead of the newest
    std::string settings;              ///< text of the run's settings
    std::vector<std::string> reported_warnings;
    bool may_close_unsaved = false;
    bool close_when_written = false;
    std::size_t notices = 0;  ///< number of notices of the live source that were shown
  };

  void build();
  wxWindow* build_middle();
  void build_toolbar();
  void bind_commands();
  void bind_file_commands();
  void bind_view_commands();
  void bind_edit_commands();
  void on(int command, const std::function<void()>& action);
  void on_file(int command, const FileQuestion& question,
               const std::function<void(MainFrame&, const std::filesystem::path&)>& action);
  /// The panes that the menu View shows and hides, with their commands.
  std::array<std::pair<wxWindow*, int>, 3> optional_panes() const;

  void press_key(wxKeyEvent& event);

  void refresh();
  void show_live_figures();
  void report_changes(const ReplaySnapshot& snapshot, const ReplaySnapshot& before);
  void report_warnings(const std::vector<std::string>& warnings);
  void report_save(const WriteOutcome& outcome);
  void report_export(const WriteOutcome& outcome);
  void report_edit(const ReplaySnapshot& snapshot);
  void enable_commands();
  void enable_edit_commands();
  void close(wxCloseEvent& event);
  bool has_unsaved_work() const;
  bool has_unsaved_edits() const;
  bool is_live() const { return replay_ && replay_->snapshot()->live; }
  /// True while scans of a live source are mapped.
  bool is_connected() const;
  /// Calls `action`, but asks first if unsaved edits or an unsaved live map would be lost. `question` and
  /// `answer` name the action.
  void ask_before_loss(const std::string& question, const std::string& answer,
                       const std::function<void()>& action);
  /// True while the run has not processed an edit that the user made. Snapshots lack such an edit.
  bool edits_are_pending() const;

  std::vector<std::string> take_settings_of(const SessionFacts& facts, const std::filesystem::path& file,
                                            const std::function<void(BoundSettings&)>& overrule);
  enum class Edits { kOfFile, kMadeSoFar };
  /// Opens a run. Throws UserError if the run resumes a session and settings that shape the map have changed.
  void open(SessionInput input, Edits edits);
  /// Clears what the window shows of a run, before another run is opened.
  void clear_run();
  /// Shows the run that was opened.
  void show_run();
  /// Calls `action` and shows its exception, if any, in the message bar.
  void attempt(const std::function<void()>& action);
  /// Sets the check marks of the menus to the visible layers, loops and panes.
  void check_choices();
  void show_layers();
  void play_or_pause();
  void finish();
  void restart();
  /// Shows whether the settings differ from those of the run.
  void show_pending_settings();
  /// Chooses one of kSpeeds by its index.
  void set_speed(int choice);
  void choose_loop(std::optional<std::size_t> loop);
  void edit_selected(LoopEdit::Kind kind, MatcherKind matcher = MatcherKind::kCsm);
  void toggle_adding_loop();
  void click_place(const mrpt::math::TPoint2D& place);
  void bind_map_tools();
  /// Begins to draw an edit of the map, or cancels it if it is being drawn.
  void choose_map_tool(MapEdit::Kind kind);
  /// Ends a tool that waits for clicks, without an edit.
  void stop_pointing();
  void add_point(const mrpt::math::TPoint2D& place);
  void remove_last_point();
  /// Makes the edit that is being drawn if it has enough points.
  void close_draft();
  void show_draft();
  /// Returns whether a key belongs to the drawing of an edit, after having served it.
  bool serve_drawing_key(int key);
  void show_map_menu();
  void map_again_with(const std::filesystem::path& edits);
  /// All edits of the run. Throws UserError while an edit is pending.
  EditJournal edits() const;
  void add_to_recent_logs();
  void show_status(const std::string& text);

  BoundSettings settings_;
  ReplaySlot replay_;
  SessionReader session_reader_;
  UnsavedWork unsaved_;
  RunState run_;
  double speed_ = 0;
  std::filesystem::path opened_;                         ///< log or session that is open
  std::map<std::string, std::string> session_settings_;  ///< settings of the session that cannot change
  std::optional<mrpt::math::TPoint2D> first_place_;      ///< first of the two clicks that add a loop
  std::optional<MapEdit> draft_;                         ///< edit of the map that is being drawn

  AskForFile ask_for_file_;
  AskForPort ask_for_port_;
  AskForSpeed ask_for_speed_;
  wxAuiManager panes_;
  wxString default_panes_;
  wxFileHistory recent_;
  wxTimer timer_;
  static constexpr int kMapPage = 1;  // page of middle_ with the map; page 0 is the start page
  wxSimplebook* middle_ = nullptr;
  MessageBar* messages_ = nullptr;
  MapCanvas* canvas_ = nullptr;
  TransportBar* transport_ = nullptr;
  SettingsPanel* settings_panel_ = nullptr;
  LoopInspector* loops_ = nullptr;
  PlotPanel* plots_ = nullptr;
};

}  // namespace psi_slam
