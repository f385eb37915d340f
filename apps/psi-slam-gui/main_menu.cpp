// SPDX-License-Identifier: BSD-3-Clause
#include "main_menu.h"

#include <mrpt/system/os.h>
#include <wx/version.h>
#include <wx/window.h>

#include <string>

#include "icons.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

wxString utf8(const char* text) {
  return wxString::FromUTF8(text);
}

wxMenu* file_menu(wxMenu* recent) {
  auto* menu = new wxMenu;
  menu->Append(kOpenLog, utf8("&Open log or session…\tCtrl+O"));
  menu->Append(kOpenFolder, utf8("Open &folder of a ROS 2 bag…"));
  menu->AppendSubMenu(recent, "&Recent logs");
  menu->AppendSeparator();
  menu->Append(kResumeWithLog, utf8("Resume session with its lo&g…"));
  menu->Append(kSaveSession, utf8("Save sessio&n…\tCtrl+S"));
  menu->AppendSeparator();
  menu->Append(kOpenSettings, utf8("Open &settings…\tCtrl+Shift+O"));
  menu->Append(kSaveSettings, utf8("Save se&ttings…\tCtrl+Shift+S"));
  menu->Append(kResetSettings, "Reset a&ll settings");
  menu->AppendSeparator();
  menu->Append(kExport, utf8("&Export results…\tCtrl+E"));
  menu->Append(kSavePicture, utf8("Save map view as &picture…\tCtrl+P"));
  menu->AppendSeparator();
  menu->Append(kQuit, "&Quit\tCtrl+Q");
  return menu;
}

wxMenu* edit_menu() {
  auto* menu = new wxMenu;
  menu->Append(kUndo, "&Undo\tCtrl+Z");
  menu->Append(kRedo, "&Redo\tCtrl+Shift+Z");
  menu->AppendSeparator();
  menu->Append(kDeleteLoop, "&Delete selected loop (Delete)");
  menu->Append(kForceLoop, "&Force selected loop");
  for (std::size_t i = 0; i < kMatcherChoices.size(); ++i)
    menu->Append(kMatchLoopBy + static_cast<int>(i),
                 wxString("Match selected loop again: ") + kMatcherChoices[i].title);
  menu->Append(kRestoreLoop, "Re&store selected loop");
  menu->AppendCheckItem(kAddLoop, "&Add loop by two clicks (L)");
  menu->AppendSeparator();
  menu->Append(kOpenEdits, utf8("&Open loop edits…"));
  menu->Append(kSaveEdits, utf8("Sa&ve loop edits…"));
  return menu;
}

wxMenu* run_menu() {
  auto* menu = new wxMenu;
  menu->Append(kPlayOrPause, "&Play or pause (Space)");
  menu->Append(kStep, "&Map one scan (.)");
  menu->Append(kFinish, "&Finish map now\tCtrl+Return");
  menu->Append(kRestart, "&Restart from first scan\tCtrl+R");
  menu->AppendSeparator();
  for (std::size_t i = 0; i < kSpeeds.size(); ++i)
    menu->AppendRadioItem(kSpeed + static_cast<int>(i),
                          "Speed: " + speed_text(kSpeeds[i]) + wxString::Format("\tAlt+%zu", i + 1));
  menu->Check(kSpeed + static_cast<int>(kSpeeds.size()) - 1, true);
  return menu;
}

wxMenu* view_menu() {
  auto* menu = new wxMenu;
  menu->Append(kFitMap, "Fit &map (Home)");
  menu->Append(kTopView, "&Top view (T)");
  menu->AppendCheckItem(kFollow, "&Follow robot (F)");
  menu->AppendCheckItem(kMeasure, "M&easure distance (M)");
  menu->AppendSeparator();
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    const auto layer = static_cast<MapLayer>(i);
    const wxString key = wxString::Format("\tCtrl+%zu", (i + 1) % 10);
    menu->AppendCheckItem(kLayer + static_cast<int>(i), name_of(layer) + key)->Check(shown_at_first(layer));
  }
  menu->AppendCheckItem(kRefusedLoops, "Refused loops");
  menu->AppendSeparator();
  menu->AppendRadioItem(kLoopsByMatcher, "Colour loops by matcher");
  menu->AppendRadioItem(kLoopsByResidual, "Colour loops by residual");
  menu->AppendSeparator();
  menu->AppendCheckItem(kPaneSettings, "Settings\tF9")->Check();
  menu->AppendCheckItem(kPaneLoops, "Loops\tF10")->Check();
  menu->AppendCheckItem(kPanePlots, "Plots\tF11")->Check();
  menu->Append(kDefaultLayout, "Restore &default layout");
  return menu;
}

}  // namespace

wxString speed_text(double speed) {
  if (speed <= 0) return "as fast as possible";
  return wxString::Format("%g", speed) + utf8("×");
}

wxMenuBar* make_menu_bar(wxMenu* recent) {
  auto* bar = new wxMenuBar;
  bar->Append(file_menu(recent), "&File");
  bar->Append(edit_menu(), "&Edit");
  bar->Append(run_menu(), "&Run");
  bar->Append(view_menu(), "&View");
  auto* help = new wxMenu;
  help->Append(kShortcuts, "Mouse and &keys\tF1");
  help->Append(kAbout, "&About psi-slam");
  bar->Append(help, "&Help");
  return bar;
}

void choose_command(wxWindow& from, int command) {
  from.GetEventHandler()->QueueEvent(new wxCommandEvent(wxEVT_MENU, command));
}

int command_of_key(int key) {
  switch (key) {
    case WXK_SPACE:
      return kPlayOrPause;
    case '.':
      return kStep;
    case WXK_HOME:
      return kFitMap;
    case 'T':
      return kTopView;
    case 'F':
      return kFollow;
    case 'M':
      return kMeasure;
    case 'L':
      return kAddLoop;
    case WXK_DELETE:
      return kDeleteLoop;
    default:
      return wxID_NONE;
  }
}

const char* hint_text() {
  return "Space: play or pause. In the map: drag to move, right-drag to rotate, turn the wheel to zoom. F1: "
         "all "
         "keys";
}

const char* shortcuts_text() {
  return "Space plays or pauses, \".\" maps one scan. In the map: drag to move, right-drag to rotate and "
         "tilt, "
         "turn the wheel to zoom. Home fits the map, T shows the top view, F follows the robot, M measures a "
         "distance. L adds a loop, Delete deletes the selected loop, Ctrl+Z undoes the last edit.";
}

wxAboutDialogInfo about_info() {
  wxAboutDialogInfo info;
  info.SetName("psi-slam");
  info.SetVersion(PSI_SLAM_VERSION);
  info.SetDescription(utf8("Builds floor plans from 2D lidar scans and wheel odometry:\n"
                           "graph SLAM with genetic loop matching. The factor Ψ selects the matcher.\n\n"
                           "Built with ") +
                      utf8(mrpt::system::MRPT_getVersion().c_str()) + " and " + wxString(wxVERSION_STRING) +
                      ".");
  info.SetLicence("BSD 3-Clause");
  info.SetIcon(program_icon().GetIcon(wxSize(64, 64)));
  return info;
}

}  // namespace psi_slam
