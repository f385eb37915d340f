// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <wx/image.h>
#include <wx/timer.h>
#include <wx/uiaction.h>

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "gui_app.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "sanitizer.h"
#include "screen_image.h"
#include "temporary_folder.h"

namespace psi_slam {

/// Runs the real program and controls it from its event loop. A test is a list of steps. Each step starts
/// when the previous step has succeeded.
class GuiRun {
 public:
  GuiRun() {
    setenv("XDG_CONFIG_HOME", (folder_.path() / "config").c_str(), 1);
    setenv("HOME", folder_.path().c_str(), 1);
  }

  static bool has_display() { return std::getenv("PSI_SLAM_GUI_TEST_DISPLAY") != nullptr; }

  const std::filesystem::path& folder() const { return folder_.path(); }
  std::ostringstream out;
  std::ostringstream err;

  /// Adds a step that waits until `condition` is true. `what` names the step in error messages.
  GuiRun& when(std::string what, std::function<bool(MainFrame&)> condition) {
    steps_.push_back({std::move(what), std::move(condition)});
    return *this;
  }
  GuiRun& then(std::function<void(MainFrame&)> action) {
    return when("", [action](MainFrame& frame) { return action(frame), true; });
  }
  /// Waits until a menu command is enabled, and chooses it.
  GuiRun& command(int id) {
    when("command " + std::to_string(id) + " is enabled",
         [id](MainFrame& frame) { return frame.GetMenuBar()->IsEnabled(id); });
    return then([id](MainFrame& frame) { choose(frame, id); });
  }
  /// Chooses a command like a click on its menu item.
  static void choose(MainFrame& frame, int id) {
    wxMenuItem* const item = frame.GetMenuBar()->FindItem(id);
    if (item->IsCheckable()) item->Check(item->IsRadio() || !item->IsChecked());
    wxCommandEvent event(wxEVT_MENU, id);
    event.SetEventObject(&frame);
    frame.GetEventHandler()->ProcessEvent(event);
  }
  GuiRun& when_phase(ReplayPhase phase) {
    return when("phase " + std::to_string(static_cast<int>(phase)), [phase](MainFrame& frame) {
      return frame.replay() && frame.replay()->snapshot()->phase == phase;
    });
  }
  /// Waits 0.7 s for the window to be drawn, and saves a picture of it as `name`.png in pictures().
  GuiRun& screenshot(const std::string& name) {
    pause(700);
    return then([name](MainFrame& frame) {
      std::filesystem::create_directories(pictures());
      const double scale = frame.GetContentScaleFactor();
      const wxSize size = frame.GetSize() * scale;
      const wxImage image = screen_image(frame.GetPosition() * scale, size);
      EXPECT_TRUE(image.SaveFile((pictures() / (name + ".png")).string(), wxBITMAP_TYPE_PNG));
    });
  }
  /// Moves the real mouse pointer to a point of a window, given as fractions of its width and height.
  GuiRun& mouse_to(const std::string& window, double x_share, double y_share) {
    then([=](MainFrame& frame) {
      const wxWindow* const target = wxWindow::FindWindowByName(window, &frame);
      const wxRect area = target->GetScreenRect();
      wxUIActionSimulator().MouseMove(area.x + static_cast<long>(area.width * x_share),
                                      area.y + static_cast<long>(area.height * y_share));
    });
    return pause(100);
  }
  GuiRun& mouse_down() {
    then([](MainFrame&) { wxUIActionSimulator().MouseDown(); });
    return pause(100);
  }
  GuiRun& mouse_up() {
    then([](MainFrame&) { wxUIActionSimulator().MouseUp(); });
    return pause(100);
  }
  /// Sends a key to the map as if it had the focus, because no control has the focus without a window
  /// manager.
  GuiRun& key(int code) {
    then([code](MainFrame& frame) {
      wxKeyEvent event(wxEVT_CHAR_HOOK);
      event.m_keyCode = code;
      event.SetEventObject(&frame.map());
      frame.map().GetEventHandler()->ProcessEvent(event);
    });
    return pause(100);
  }
  GuiRun& pause(int milliseconds) {
    const auto until = std::make_shared<std::chrono::steady_clock::time_point>();
    then([until, milliseconds](MainFrame&) {
      *until = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
    });
    return when("a pause", [until](MainFrame&) { return std::chrono::steady_clock::now() >= *until; });
  }
  /// Starts to record the longest gap between events as `name`. The gaps include the time of the steps.
  GuiRun& gauge(const std::string& name) {
    return then([this, name](MainFrame&) {
      gauges_.push_back({name, {}});
      ticked_ = std::chrono::steady_clock::now();
    });
  }
  /// Sets how long a step may take.
  GuiRun& patience(std::chrono::minutes limit) {
    limit_ = limit;
    return *this;
  }
  GuiRun& close() {
    return then([](MainFrame& frame) { frame.Close(); });
  }

  /// Runs the program until its window is closed and returns its exit code. Fails the test if a step does not
  /// succeed in time.
  int run(const std::vector<std::string>& arguments) {
    const int code = run_gui(arguments, out, err, [this](MainFrame& frame) {
      frame_ = &frame;
      frame.Bind(wxEVT_DESTROY, [this](wxWindowDestroyEvent& event) {
        if (event.GetEventObject() == frame_) {
          timer_.reset();
          frame_ = nullptr;
        }
        event.Skip();
      });
      timer_ = std::make_unique<Timer>([this] { advance(); });
      timer_->Start(20);
      began_ = std::chrono::steady_clock::now();
    });
    EXPECT_EQ(err.str(), "");
    const auto gap_ms = std::chrono::duration_cast<std::chrono::milliseconds>(longest_gap_).count();
    testing::Test::RecordProperty("longest_gap_between_events_ms", static_cast<int>(gap_ms));
    std::cout << "longest gap between two events: " << gap_ms << " ms\n";
    for (const Gauge& gauge : gauges_) {
      const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(gauge.longest).count();
      testing::Test::RecordProperty("longest_gap_ms_" + gauge.name, static_cast<int>(ms));
      std::cout << "  " << gauge.name << ": " << ms << " ms, of work "
                << static_cast<int>(gauge.longest_cpu_ms) << " ms\n";
    }
    return code;
  }

  /// Folder of the screenshots.
  static std::filesystem::path pictures() { return std::filesystem::path(PSI_SLAM_GUI_PICTURES); }

 private:
  struct Step {
    std::string what;
    std::function<bool(MainFrame&)> condition;
  };
  struct Gauge {
    std::string name;
    std::chrono::steady_clock::duration longest{};
    double longest_cpu_ms = 0;  // longest processor time of the window's thread between two events
  };
  class Timer : public wxTimer {
   public:
    explicit Timer(std::function<void()> tick) : tick_(std::move(tick)) {}
    void Notify() override { tick_(); }

   private:
    std::function<void()> tick_;
  };

  void advance() {
    if (frame_ == nullptr || busy_) return;
    busy_ = true;
    const auto now = std::chrono::steady_clock::now();
    if (ticked_.time_since_epoch().count() > 0) count_gap(now - ticked_);
    if (next_ < steps_.size() && steps_[next_].condition(*frame_)) {
      ++next_;
      began_ = now;
    } else if (next_ < steps_.size() && now - began_ > limit_) {
      ADD_FAILURE() << "step " << next_ << " does not succeed: " << steps_[next_].what;
      next_ = steps_.size();
    }
    // The time of a step does not count as a gap before gauge() is called.
    if (gauges_.empty())
      ticked_ = std::chrono::steady_clock::now();
    else
      ticked_ = now;
    busy_ = false;
    if (next_ >= steps_.size() && frame_ != nullptr && !closing_) {
      closing_ = true;
      frame_->Close(true);
    }
  }

  /// Processor time of the window's thread so far, in ms.
  static double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) / 1e6;
  }

  void count_gap(std::chrono::steady_clock::duration gap) {
    const double worked_ms = cpu_ms() - cpu_ms_before_;
    cpu_ms_before_ += worked_ms;
    longest_gap_ = std::max(longest_gap_, gap);
    if (gauges_.empty()) return;
    gauges_.back().longest = std::max(gauges_.back().longest, gap);
    gauges_.back().longest_cpu_ms = std::max(gauges_.back().longest_cpu_ms, worked_ms);
  }

  TemporaryFolder folder_;
  std::vector<Step> steps_;
  std::size_t next_ = 0;
  bool busy_ = false;
  bool closing_ = false;
  std::chrono::steady_clock::time_point began_;
  std::chrono::steady_clock::time_point ticked_;
  std::chrono::steady_clock::duration longest_gap_{};
  std::vector<Gauge> gauges_;
  double cpu_ms_before_ = 0;
  std::chrono::steady_clock::duration limit_ = std::chrono::minutes(kHasAddressSanitizer ? 4 : 1);
  MainFrame* frame_ = nullptr;
  std::unique_ptr<Timer> timer_;
};

}  // namespace psi_slam
