// SPDX-License-Identifier: BSD-3-Clause
// Drives the real program through its event loop: a test is a list of steps, each done once the one before
// has come true.
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
#include "screen_image.h"
#include "temporary_folder.h"

namespace psi_slam {

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

  /// Waits until this is true.
  GuiRun& when(std::string what, std::function<bool(MainFrame&)> condition) {
    steps_.push_back({std::move(what), std::move(condition)});
    return *this;
  }
  GuiRun& then(std::function<void(MainFrame&)> action) {
    return when("", [action](MainFrame& frame) { return action(frame), true; });
  }
  /// Chooses a menu's command, once it can be chosen.
  GuiRun& command(int id) {
    when("command " + std::to_string(id) + " is enabled",
         [id](MainFrame& frame) { return frame.GetMenuBar()->IsEnabled(id); });
    return then([id](MainFrame& frame) { choose(frame, id); });
  }
  /// As a click on the menu's item does.
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
  /// Lets the window draw itself, and takes a picture of the screen there.
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
  /// With a real mouse: to a window's point, in shares of its size.
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
  /// A key that the window gets before whoever has the focus; without a window manager there is no focus to
  /// type to.
  GuiRun& key(int code) {
    then([code](MainFrame& frame) {
      wxKeyEvent event(wxEVT_CHAR_HOOK);
      event.m_keyCode = code;
      event.SetEventObject(&frame);
      frame.GetEventHandler()->ProcessEvent(event);
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
  /// From here on gaps between events are counted under this name; what the steps themselves do counts, too.
  GuiRun& gauge(const std::string& name) {
    return then([this, name](MainFrame&) {
      gauges_.push_back({name, {}});
      ticked_ = std::chrono::steady_clock::now();
    });
  }
  /// A step may take that long to come true.
  GuiRun& patience(std::chrono::minutes limit) {
    limit_ = limit;
    return *this;
  }
  GuiRun& close() {
    return then([](MainFrame& frame) { frame.Close(); });
  }

  /// The program's exit code, once its window is closed; a failed expectation when a step does not come true.
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

  /// Where the screenshots are.
  static std::filesystem::path pictures() { return std::filesystem::path(PSI_SLAM_GUI_PICTURES); }

 private:
  struct Step {
    std::string what;
    std::function<bool(MainFrame&)> condition;
  };
  struct Gauge {
    std::string name;
    std::chrono::steady_clock::duration longest{};
    double longest_cpu_ms = 0;  // of the window's thread
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
      ADD_FAILURE() << "step " << next_ << " does not come true: " << steps_[next_].what;
      next_ = steps_.size();
    }
    // What the step itself took is not the window's, unless it is gauged.
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

  /// What the window's thread has worked so far.
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
  std::chrono::steady_clock::duration limit_ = std::chrono::minutes(1);
  MainFrame* frame_ = nullptr;
  std::unique_ptr<Timer> timer_;
};

}  // namespace psi_slam
