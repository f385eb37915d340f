// SPDX-License-Identifier: BSD-3-Clause
#include "main_menu.h"

#include <mrpt/system/os.h>
#include <wx/version.h>
#include <wx/window.h>

#include <initializer_list>
#include <map>

#include "icons.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

wxString utf8(const char* text) {
  return wxString::FromUTF8(text);
}

struct Item {
  int command = wxID_SEPARATOR;
  const char* label = "";
  wxItemKind kind = wxITEM_NORMAL;
};

/// Appends items to a menu and returns the menu. Items without a command are separators.
wxMenu* append(wxMenu* menu, std::initializer_list<Item> items) {
  for (const Item& item : items) menu->Append(item.command, utf8(item.label), "", item.kind);
  return menu;
}

wxMenu* file_menu(wxMenu* recent) {
  wxMenu* const menu = append(new wxMenu, {{kOpenLog, "&Open log or session…\tCtrl+O"},
                                           {kOpenFolder, "Open &folder of a ROS 2 bag…"}});
  menu->AppendSubMenu(recent, "&Recent logs");
  menu->AppendSeparator();
  menu->AppendSubMenu(append(new wxMenu, {{kConnectTcp, "Receive CARMEN lines on a TCP &port…"},
                                          {kConnectLog, "Follow a &growing log or bag…"},
                                          {kConnectFolder, "Follow the growing &folder of a ROS 2 bag…"},
                                          {kConnectSensors, "Read &sensors of a settings file…"}}),
                      "&Connect");
  return append(menu, {{kDisconnect, "&Disconnect and finish map"},
                       {},
                       {kResumeWithLog, "Resume session with its lo&g…"},
                       {kSaveSession, "Save sessio&n…\tCtrl+S"},
                       {},
                       {kOpenSettings, "Open &settings…\tCtrl+Shift+O"},
                       {kSaveSettings, "Save se&ttings…\tCtrl+Shift+S"},
                       {kResetSettings, "Reset a&ll settings"},
                       {},
                       {kExport, "&Export results…\tCtrl+E"},
                       {kSavePicture, "Save map view as &picture…\tCtrl+P"},
                       {},
                       {kQuit, "&Quit\tCtrl+Q"}});
}

wxMenu* edit_menu() {
  wxMenu* const menu = append(new wxMenu, {{kUndo, "&Undo\tCtrl+Z"},
                                           {kRedo, "&Redo\tCtrl+Shift+Z"},
                                           {},
                                           {kDeleteLoop, "&Delete selected loop (Delete)"},
                                           {kForceLoop, "&Force selected loop"}});
  for (std::size_t i = 0; i < kMatcherKinds.size(); ++i)
    menu->Append(kMatchLoopBy + static_cast<int>(i),
                 wxString("Match selected loop again: ") + kMatcherTitles[i]);
  append(menu, {{kRestoreLoop, "Re&store selected loop"},
                {kAddLoop, "&Add loop by two clicks (L)", wxITEM_CHECK},
                {}});
  menu->AppendSubMenu(make_map_menu(), "&Map");
  return append(menu, {{}, {kOpenEdits, "&Open edits…"}, {kSaveEdits, "Sa&ve edits…"}});
}

wxMenu* run_menu() {
  wxMenu* const menu = append(new wxMenu, {{kPlayOrPause, "&Play or pause (Space)"},
                                           {kStep, "&Map one scan (.)"},
                                           {kFinish, "&Finish map now\tCtrl+Return"},
                                           {kRestart, "&Restart from first scan\tCtrl+R"},
                                           {}});
  for (std::size_t i = 0; i < kSpeeds.size(); ++i)
    menu->AppendRadioItem(kSpeed + static_cast<int>(i),
                          "Speed: " + speed_text(kSpeeds[i]) + wxString::Format("\tAlt+%zu", i + 1));
  menu->Check(kSpeed + static_cast<int>(kSpeeds.size()) - 1, true);
  return menu;
}

wxMenu* view_menu() {
  wxMenu* const menu = append(new wxMenu, {{kFitMap, "Fit &map (Home)"},
                                           {kTopView, "&Top view (T)"},
                                           {kFollow, "&Follow robot (F)", wxITEM_CHECK},
                                           {kMeasure, "M&easure distance (M)", wxITEM_CHECK},
                                           {}});
  for (std::size_t i = 0; i < kMapLayers; ++i)
    menu->AppendCheckItem(kLayer + static_cast<int>(i),
                          name_of(static_cast<MapLayer>(i)) +
                              (i < 10 ? wxString::Format("\tCtrl+%zu", (i + 1) % 10) : wxString()));
  return append(menu, {{kRejectedLoops, "Rejected loops", wxITEM_CHECK},
                       {},
                       {kLoopsByMatcher, "Colour loops by matcher", wxITEM_RADIO},
                       {kLoopsByResidual, "Colour loops by residual", wxITEM_RADIO},
                       {},
                       {kPaneSettings, "Settings\tF9", wxITEM_CHECK},
                       {kPaneLoops, "Loops\tF10", wxITEM_CHECK},
                       {kPanePlots, "Plots\tF11", wxITEM_CHECK},
                       {kDefaultLayout, "Restore &default layout"}});
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
  bar->Append(append(new wxMenu, {{kShortcuts, "Mouse and &keys\tF1"}, {kAbout, "&About psi-slam"}}),
              "&Help");
  return bar;
}

wxMenu* make_map_menu() {
  auto* const menu = new wxMenu;
  for (std::size_t i = 0; i < kMapTools.size(); ++i)
    menu->AppendCheckItem(kMapTool + static_cast<int>(i), utf8(kMapTools[i].label));
  return menu;
}

void choose_command(wxWindow& from, int command) {
  from.GetEventHandler()->QueueEvent(new wxCommandEvent(wxEVT_MENU, command));
}

int command_of_key(int key) {
  static const std::map<int, int> kCommands{
      {WXK_SPACE, kPlayOrPause}, {'.', kStep},    {WXK_HOME, kFitMap},      {'T', kTopView}, {'F', kFollow},
      {'M', kMeasure},           {'L', kAddLoop}, {WXK_DELETE, kDeleteLoop}};
  const auto found = kCommands.find(key);
  return found == kCommands.end() ? wxID_NONE : found->second;
}

const char* hint_text() {
  return "Space: play or pause. In the map: drag to move, right-drag to rotate, turn the wheel to zoom. "
         "F1: all keys";
}

const char* shortcuts_text() {
  return "Space plays or pauses, \".\" maps one scan. In the map: drag to move, right-drag to rotate and "
         "tilt, turn the wheel to zoom. Home fits the map, T shows the top view, F follows the robot, M "
         "measures a distance. L adds a loop, Delete deletes the selected loop, Ctrl+Z undoes the last edit. "
         "Edit "
         "> Map: click the corners, close with Enter, a double click or a right click.";
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
