// SPDX-License-Identifier: BSD-3-Clause
// The window's menus, with their keys.
#pragma once

#include <wx/menu.h>

#include "matching/make_matcher.h"
#include "view/map_scene.h"

namespace psi_slam {

enum Command : int {
  kOpenLog = wxID_OPEN,
  kExport = wxID_SAVE,
  kQuit = wxID_EXIT,
  kAbout = wxID_ABOUT,
  kOpenSettings = wxID_HIGHEST + 100,
  kSaveSettings,
  kResetSettings,
  kSavePicture,
  kPlayOrPause,
  kStep,
  kFinish,
  kRestart,
  kSpeed,                // and one more for each of the speeds
  kLayer = kSpeed + 20,  // and one more for each layer
  kLoopsByMatcher = kLayer + 20,
  kLoopsByResidual,
  kRefusedLoops,
  kShowAll,
  kFromAbove,
  kFollow,
  kMeasure,
  kPaneSettings,
  kPaneLoops,
  kPanePlots,
  kDefaultLayout,
  kOpenFolder,
  kSaveSession,
  kGoOnWithLog,
  kShortcuts,
  kUndo = wxID_UNDO,
  kRedo = wxID_REDO,
  kDeleteLoop = kShortcuts + 1,
  kForceLoop,
  kRestoreLoop,
  kMatchLoop,
  kMatchLoopBy,  // and one more for each matcher
  kAddLoop = kMatchLoopBy + 10,
  kOpenEdits,
  kSaveEdits,
};

inline constexpr int kMatchers = 3;
MatcherKind matcher_kind_of(int number);
wxString matcher_title(int number);

/// `recent` is filled and kept by whoever remembers the files.
wxMenuBar* make_menu_bar(wxMenu* recent);

/// What a key alone stands for, where nobody is typing a text; wxID_NONE for others. (As keys of the menu
/// they would be taken from text fields, too.)
int command_of_key(int key);

/// What mouse and keys do: the most important, in a line, and all of it.
const char* hint_text();
const char* shortcuts_text();

}  // namespace psi_slam
