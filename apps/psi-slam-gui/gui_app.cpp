// SPDX-License-Identifier: BSD-3-Clause
#include "gui_app.h"

#include <wx/app.h>
#include <wx/cmdline.h>
#include <wx/fileconf.h>
#include <wx/filename.h>
#include <wx/image.h>
#include <wx/init.h>
#include <wx/log.h>
#include <wx/stdpaths.h>

#include <array>
#include <exception>
#include <ostream>

#include "gui_command_line.h"
#include "main_frame.h"
#include "base/exit_code.h"
#include "run_program.h"

namespace psi_slam {
namespace {

class GuiApp : public wxApp {
 public:
  GuiApp(GuiCommandLine line, std::function<void(MainFrame&)> when_shown)
      : line_(std::move(line)), when_shown_(std::move(when_shown)) {
    SetAppName("psi-slam-gui");
    SetAppDisplayName("psi-slam");
  }

  bool OnInit() override {
    wxInitAllImageHandlers();
    wxStandardPaths::Get().SetFileLayout(wxStandardPathsBase::FileLayout_XDG);
    keep_choices();
    auto* frame = new MainFrame();  // wx deletes it when it is closed
    frame->Show();
    frame->start(line_.log, line_.config, line_.settings, line_.edits);
    if (when_shown_) frame->CallAfter([this, frame] { when_shown_(*frame); });
    return true;
  }

  /// What no command has told: the window goes on, with all that was mapped and edited.
  bool OnExceptionInMainLoop() override {
    auto* const frame = dynamic_cast<MainFrame*>(GetTopWindow());
    if (frame == nullptr) return wxApp::OnExceptionInMainLoop();
    frame->tell_failure(std::current_exception());
    return true;
  }

  // Arguments were read before there was any window.
  void OnInitCmdLine(wxCmdLineParser& parser) override { parser.SetCmdLine(wxString()); }

 private:
  /// Recent files and the like go where the desktop keeps such things; without that place they are forgotten.
  static void keep_choices() {
    const wxLogNull quiet;
    const wxString folder = wxStandardPaths::Get().GetUserConfigDir();
    wxFileName::Mkdir(folder, wxS_DIR_DEFAULT, wxPATH_MKDIR_FULL);
    wxConfigBase::Set(new wxFileConfig("psi-slam-gui", "", folder + "/psi-slam-gui.conf"));
  }

  GuiCommandLine line_;
  std::function<void(MainFrame&)> when_shown_;
};

int run_window(const GuiCommandLine& line, std::ostream& err,
               const std::function<void(MainFrame&)>& when_shown) {
  wxApp::SetInstance(new GuiApp(line, when_shown));  // wx deletes it
  std::string name = "psi-slam-gui";
  std::array<char*, 2> argv{name.data(), nullptr};
  int argc = 1;
  if (!wxEntryStart(argc, argv.data())) {
    err << "psi-slam-gui: there is no display to open a window on; psi-slam maps without one\n";
    return kExitFailed;
  }
  int code = kExitFailed;
  if (wxTheApp->CallOnInit()) code = wxTheApp->OnRun();
  wxTheApp->OnExit();
  delete wxConfigBase::Set(nullptr);
  wxEntryCleanup();
  return code;
}

}  // namespace

int run_gui(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
            const std::function<void(MainFrame&)>& when_shown) {
  CLI::App app("psi-slam-gui replays a log and shows the map being made.", "psi-slam-gui");
  return run_program(app, out, err, [&] {
    const GuiCommandLine line = parse_gui_command_line(arguments, app);
    BoundSettings bound;
    bound.load(line.config, line.settings);  // reports mistakes before the window opens
    for (const std::string& warning : bound.table.take_warnings()) err << "psi-slam-gui: " << warning << '\n';
    if (!line.edits.empty()) EditJournal::read(line.edits);
    return run_window(line, err, when_shown);
  });
}

}  // namespace psi_slam
