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
#include <CLI/CLI.hpp>

#include <array>
#include <exception>
#include <ostream>

#include "base/exit_code.h"
#include "command_line.h"
#include "document_options.h"
#include "live_arguments.h"
#include "main_frame.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

struct Arguments {
  std::string log;                    ///< log or session to open; empty: opens nothing
  std::string edits;                  ///< file of edits of loops and of the drawn map; empty: no edits
  std::string config;                 ///< settings file; empty: the defaults
  std::vector<std::string> settings;  ///< "section.key=value", in the order given
  LiveArguments live;
  std::string journal;  ///< journal of the live run; empty: not written
};

/// Parses the arguments with `app`. Throws CLI::ParseError for --help, --version and syntax errors, and
/// UserError for unknown arguments, for --edits without a log and for a wrong live source.
Arguments parse(const std::vector<std::string>& arguments, CLI::App& app) {
  Arguments line;
  app.add_option("LOG", line.log,
                 "Log to open: an MRPT rawlog or a CARMEN log, plain or compressed, a ROS bag, or a session")
      ->type_name("");
  app.add_option("--edits", line.edits,
                 "File of edits of loops and of the drawn map, as saved with Edit > Save edits")
      ->type_name("FILE");
  add_source_options(app, line.live);
  add_value(app, "--journal", line.journal,
            "Record the live run in this file, to open after a crash; deleted when the run is closed",
            "FILE");
  add_settings_options(app, line.config, line.settings);
  app.set_version_flag("--version", "psi-slam-gui " PSI_SLAM_VERSION, "Print the version and exit");
  add_document_options(
      app,
      {{"The window was closed.", "Something failed, such as opening the display.",
        "The arguments, the settings or the edits are invalid. The window itself reports an invalid log."},
       default_settings()});
  app.allow_extras();
  // CLI11 expects the last argument first.
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
    throw UserError(unknown_argument_text(unknown.front(), app, "psi-slam-gui"));
  if (!line.edits.empty() && line.log.empty())
    throw UserError("--edits needs a log: name the log that the edits belong to");
  const bool is_live = live_input(line.live).has_value();
  if (is_live && !line.log.empty()) throw UserError("name a log or a live source, not both");
  if (!line.journal.empty() && !is_live)
    throw UserError("--journal needs a live source, such as --tcp PORT or --follow LOG");
  if (std::filesystem::exists(line.journal))
    throw UserError("--journal " + line.journal + ": the file exists. Open it with psi-slam-gui " +
                    line.journal + ", or delete it");
  return line;
}

class GuiApp : public wxApp {
 public:
  GuiApp(Arguments line, std::function<void(MainFrame&)> when_shown)
      : line_(std::move(line)), when_shown_(std::move(when_shown)) {
    SetAppName("psi-slam-gui");
    SetAppDisplayName("psi-slam");
  }

  bool OnInit() override {
    wxInitAllImageHandlers();
    wxStandardPaths::Get().SetFileLayout(wxStandardPathsBase::FileLayout_XDG);
    open_preferences();
    auto* frame = new MainFrame();  // wxWidgets deletes the frame when it is closed
    frame->Show();
    frame->start(line_.log, line_.config, line_.settings, line_.edits);
    if (const auto source = live_input(line_.live)) frame->connect(*source, line_.journal);
    if (when_shown_) frame->CallAfter([this, frame] { when_shown_(*frame); });
    return true;
  }

  /// Reports an exception that no command has caught. The window stays open, so that no work is lost.
  bool OnExceptionInMainLoop() override {
    auto* const frame = dynamic_cast<MainFrame*>(GetTopWindow());
    if (frame == nullptr) return wxApp::OnExceptionInMainLoop();
    frame->report_failure(std::current_exception());
    return true;
  }

  // Passes no arguments to wxWidgets, because run_gui() has parsed them.
  void OnInitCmdLine(wxCmdLineParser& parser) override { parser.SetCmdLine(wxString()); }

 private:
  /// Opens the file for recent logs and the layout of the window, in the user's folder for settings.
  static void open_preferences() {
    const wxLogNull quiet;
    const wxString folder = wxStandardPaths::Get().GetUserConfigDir();
    wxFileName::Mkdir(folder, wxS_DIR_DEFAULT, wxPATH_MKDIR_FULL);
    wxConfigBase::Set(new wxFileConfig("psi-slam-gui", "", folder + "/psi-slam-gui.conf"));
  }

  Arguments line_;
  std::function<void(MainFrame&)> when_shown_;
};

int run_window(const Arguments& line, std::ostream& err, const std::function<void(MainFrame&)>& when_shown) {
  wxApp::SetInstance(new GuiApp(line, when_shown));  // wxWidgets deletes the object
  std::string name = "psi-slam-gui";
  std::array<char*, 2> argv{name.data(), nullptr};
  int argc = 1;
  if (!wxEntryStart(argc, argv.data())) {
    err << "psi-slam-gui: no display to open a window on. Set DISPLAY, or map without a window with "
           "psi-slam\n";
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
  CLI::App app("psi-slam-gui replays a log and shows how the map is built.", "psi-slam-gui");
  return run_program(app, out, err, [&] {
    const Arguments line = parse(arguments, app);
    BoundSettings bound;
    bound.load(line.config, line.settings);  // reports mistakes before the window opens
    for (const std::string& warning : bound.table.take_warnings()) err << "psi-slam-gui: " << warning << '\n';
    if (!line.edits.empty()) EditJournal::read(line.edits);
    return run_window(line, err, when_shown);
  });
}

}  // namespace psi_slam
