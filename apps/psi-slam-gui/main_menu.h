// SPDX-License-Identifier: BSD-3-Clause
// Commands of the window with their keys, the menu bar, and the texts of the Help menu.
#pragma once

#include <wx/aboutdlg.h>
#include <wx/menu.h>

#include <array>

#include "gui/map_scene.h"
#include "map/rendering/map_edits.h"
#include "matching/make_matcher.h"

namespace psi_slam {

/// Titles of kMatcherKinds, as choices for a loop that is matched again.
inline constexpr std::array<const char*, kMatcherKinds.size()> kMatcherTitles{
    "exact search (csm)", "coarse and genetic search (csm_ga)", "genetic search (ga)"};

/// A tool that edits the drawn map by clicks.
struct MapTool {
  MapEdit::Kind kind;
  const char* label;  ///< in menus
  const char* name;   ///< in the status bar
};
inline constexpr std::array<MapTool, 6> kMapTools{
    {{MapEdit::Kind::kErase, "&Erase polygon", "Erase polygon"},
     {MapEdit::Kind::kWall, "Draw &wall", "Draw wall"},
     {MapEdit::Kind::kUnknown, "Mark polygon as &unknown", "Mark polygon as unknown"},
     {MapEdit::Kind::kKeepOut, "Add &keep-out zone", "Add keep-out zone"},
     {MapEdit::Kind::kSlow, "Add &slow zone…", "Add slow zone"},
     {MapEdit::Kind::kCrop, "&Crop to polygon", "Crop to polygon"}}};

/// Choices of the replay speed, as multiples of the recorded speed; 0 is as fast as possible.
inline constexpr std::array<double, 4> kSpeeds{1, 5, 20, 0};
wxString speed_text(double speed);

enum Command : int {
  kOpenLog = wxID_OPEN,
  kExport = wxID_SAVE,
  kQuit = wxID_EXIT,
  kAbout = wxID_ABOUT,
  kUndo = wxID_UNDO,
  kRedo = wxID_REDO,
  kOpenSettings = wxID_HIGHEST + 100,
  kSaveSettings,
  kResetSettings,
  kSavePicture,
  kOpenFolder,
  kConnectTcp,
  kConnectLog,
  kConnectFolder,
  kConnectSensors,
  kDisconnect,
  kSaveSession,
  kResumeWithLog,
  kPlayOrPause,
  kStep,
  kFinish,
  kRestart,
  kFitMap,
  kTopView,
  kFollow,
  kMeasure,
  kRejectedLoops,
  kLoopsByMatcher,
  kLoopsByResidual,
  kPaneSettings,
  kPaneLoops,
  kPanePlots,
  kDefaultLayout,
  kShortcuts,
  kDeleteLoop,
  kForceLoop,
  kRestoreLoop,
  kMatchLoop,
  kAddLoop,
  kMapEdits,  // shows the menu of kMapTools
  kOpenEdits,
  kSaveEdits,
  kSpeed,                                                            // command of the first of kSpeeds
  kLayer = kSpeed + static_cast<int>(kSpeeds.size()),                // command of the first layer
  kMatchLoopBy = kLayer + static_cast<int>(kMapLayers),              // command of the first of kMatcherKinds
  kMapTool = kMatchLoopBy + static_cast<int>(kMatcherKinds.size()),  // command of the first of kMapTools
};

/// Makes the menu bar. `recent` is the submenu of recent logs, filled by the caller.
wxMenuBar* make_menu_bar(wxMenu* recent);

/// Makes the menu of kMapTools.
wxMenu* make_map_menu();

/// Sends a command to the window that contains `from`, as if it were chosen in the menu.
void choose_command(wxWindow& from, int command);

/// The command of a key that is pressed without Ctrl, Alt or Shift, or wxID_NONE. These keys are not menu
/// accelerators, which would also act while the user types in a text field.
int command_of_key(int key);

/// Help on mouse and keys. hint_text() is short enough for the status bar; shortcuts_text() names more keys.
const char* hint_text();
const char* shortcuts_text();

wxAboutDialogInfo about_info();

}  // namespace psi_slam
