// SPDX-License-Identifier: BSD-3-Clause
#include "main_menu.h"

#include <array>
#include <string>

#include "transport_bar.h"

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
  menu->Append(kGoOnWithLog, utf8("&Go on with the session in its log…"));
  menu->Append(kSaveSession, utf8("Save sessio&n…\tCtrl+S"));
  menu->AppendSeparator();
  menu->Append(kOpenSettings, utf8("Open &settings…\tCtrl+Shift+O"));
  menu->Append(kSaveSettings, utf8("Save se&ttings…\tCtrl+Shift+S"));
  menu->Append(kResetSettings, "Reset a&ll settings");
  menu->AppendSeparator();
  menu->Append(kExport, utf8("&Export results…\tCtrl+E"));
  menu->Append(kSavePicture, utf8("Save &picture of the view…\tCtrl+P"));
  menu->AppendSeparator();
  menu->Append(kQuit, "&Quit\tCtrl+Q");
  return menu;
}

wxMenu* edit_menu() {
  auto* menu = new wxMenu;
  menu->Append(kUndo, "&Undo\tCtrl+Z");
  menu->Append(kRedo, "&Redo\tCtrl+Shift+Z");
  menu->AppendSeparator();
  menu->Append(kDeleteLoop, "&Delete the selected loop (Delete)");
  menu->Append(kForceLoop, "&Force the selected loop");
  for (int matcher = 0; matcher < kMatchers; ++matcher)
    menu->Append(kMatchLoopBy + matcher, "Match it again by " + matcher_title(matcher));
  menu->Append(kRestoreLoop, "Re&store the selected loop");
  menu->AppendCheckItem(kAddLoop, "&Add a loop by two clicks (L)");
  menu->AppendSeparator();
  menu->Append(kOpenEdits, utf8("&Open loop edits…"));
  menu->Append(kSaveEdits, utf8("Sa&ve loop edits…"));
  return menu;
}

wxMenu* run_menu() {
  auto* menu = new wxMenu;
  menu->Append(kPlayOrPause, "&Play or pause (Space)");
  menu->Append(kStep, "&Step one scan (.)");
  menu->Append(kFinish, "&Finish here\tCtrl+Return");
  menu->Append(kRestart, "&Map again from the start\tCtrl+R");
  menu->AppendSeparator();
  for (std::size_t i = 0; i < TransportBar::speeds().size(); ++i) {
    const double speed = TransportBar::speeds()[i];
    const wxString key = wxString::Format("\tAlt+%zu", i + 1);
    const wxString name =
        speed > 0 ? wxString::Format("Speed %g", speed) + utf8("×") : wxString("As fast as possible");
    menu->AppendRadioItem(kSpeed + static_cast<int>(i), name + key);
  }
  menu->Check(kSpeed + static_cast<int>(TransportBar::speeds().size()) - 1, true);
  return menu;
}

wxMenu* view_menu() {
  auto* menu = new wxMenu;
  menu->Append(kShowAll, "Show &all of the map (Home)");
  menu->Append(kFromAbove, "From a&bove (T)");
  menu->AppendCheckItem(kFollow, "&Follow the robot (F)");
  menu->AppendCheckItem(kMeasure, "&Measure a distance (M)");
  menu->AppendSeparator();
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    const auto layer = static_cast<MapLayer>(i);
    const wxString key = wxString::Format("\tCtrl+%zu", (i + 1) % 10);
    menu->AppendCheckItem(kLayer + static_cast<int>(i), name_of(layer) + key)->Check(shown_at_first(layer));
  }
  menu->AppendCheckItem(kRefusedLoops, "Refused loops, too");
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

MatcherKind matcher_kind_of(int number) {
  return kMatcherKinds.at(static_cast<std::size_t>(number));
}

wxString matcher_title(int number) {
  constexpr std::array<const char*, kMatchers> kTitles{
      "exact search (csm)", "coarse cells and the GA (csm_ga)", "the GA alone (ga)"};
  return kTitles.at(static_cast<std::size_t>(number));
}

int command_of_key(int key) {
  switch (key) {
    case WXK_SPACE:
      return kPlayOrPause;
    case '.':
      return kStep;
    case WXK_HOME:
      return kShowAll;
    case 'T':
      return kFromAbove;
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
  return "Space plays and pauses. In the map: drag to move, right-drag to turn, wheel to zoom. F1: all keys";
}

const char* shortcuts_text() {
  return "Space plays and pauses, \".\" maps one scan. In the map: drag to move, right-drag to turn and "
         "tilt, wheel to "
         "zoom; Home shows all, F follows the robot, M measures. L adds a loop, Delete deletes the selected "
         "one, Ctrl+Z undoes.";
}

}  // namespace psi_slam
