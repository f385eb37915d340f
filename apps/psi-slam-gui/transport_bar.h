// SPDX-License-Identifier: BSD-3-Clause
// Play, pause, step, speed, and where in the log the replay is.
#pragma once

#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"
#include "replay/replay_snapshot.h"

class wxBitmapButton;
class wxChoice;
class wxSlider;
class wxStaticText;

namespace psi_slam {

class TransportBar : public wxPanel {
 public:
  struct Actions {
    std::function<void()> play_or_pause;
    std::function<void()> step;
    std::function<void()> finish;
    std::function<void(double)> set_speed;   ///< times the recording's; 0: as fast as possible
    std::function<void(std::size_t)> go_to;  ///< a scan, mapped already or not
  };

  TransportBar(wxWindow* parent, Actions actions);

  /// `shown` is the scan that is looked at instead of the newest. At a speed of the recording's the time left
  /// is what the log takes at it, if that is longer than the work.
  void show(const ReplaySnapshot& snapshot, const std::shared_ptr<const std::vector<TimeUs>>& stamps_us,
            std::optional<std::size_t> shown);
  void show_nothing();

  /// Whether it does something that can be paused.
  static bool goes_on(const ReplaySnapshot& snapshot);

  double speed() const;
  /// The entries of the speed choice; 0: as fast as possible.
  static const std::vector<double>& speeds();
  void set_speed(double speed);

 private:
  void enable(const ReplaySnapshot& snapshot);
  void show_slider(std::size_t at, std::size_t count);

  Actions actions_;
  wxBitmapButton* play_;
  wxBitmapButton* step_;
  wxBitmapButton* finish_;
  wxChoice* speed_;
  wxSlider* slider_;
  wxStaticText* time_;
  wxStaticText* progress_;
  bool plays_ = false;
};

/// "0:12 of 3:40", the time of a scan in its log.
std::string log_time_text(const std::vector<TimeUs>& stamps_us, std::size_t scan);

/// Until the last scan, at so many times the recording's speed, once so many scans were mapped; 0 at no
/// speed.
double replay_time_left_s(const std::vector<TimeUs>& stamps_us, std::size_t mapped, double speed);

/// What the run is doing, in a few words, with the time left: of the work, and at least so long where scans
/// are waited for.
std::string progress_words(const ReplaySnapshot& snapshot, double waiting_left_s);

}  // namespace psi_slam
