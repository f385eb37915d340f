// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/choice.h>
#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/replay_snapshot.h"
#include "psi_slam/time_stamp.h"

class wxBitmapButton;
class wxSlider;
class wxStaticText;

namespace psi_slam {

/// Buttons to play, pause, step and finish, the speed, and a slider over the log.
class TransportBar : public wxPanel {
 public:
  /// Calls `go_to` with the scan that the slider was moved to, whether it is mapped or not. Buttons and speed
  /// choice send commands to the window.
  TransportBar(wxWindow* parent, const std::function<void(std::size_t)>& go_to);

  /// Shows the state of a run. `stamps_us` may be null. `shown` is an earlier scan that is shown instead of
  /// the newest. The remaining time is the longer of the mapper's estimate and the rest of the log at the
  /// chosen speed.
  void show(const ReplaySnapshot& snapshot, const std::shared_ptr<const std::vector<TimeUs>>& stamps_us,
            std::optional<std::size_t> shown);

  /// True while the log is played, and during a final loop search that is not paused.
  static bool can_pause(const ReplaySnapshot& snapshot);

  /// Selects one of kSpeeds by its index.
  void set_speed(int choice) { speed_->SetSelection(choice); }

 private:
  wxBitmapButton* play_;
  wxBitmapButton* step_;
  wxBitmapButton* finish_;
  wxChoice* speed_;
  wxSlider* slider_;
  wxStaticText* time_;
  wxStaticText* progress_;
  bool plays_ = false;
};

/// Time of a scan since the start of the log, such as "0:12 of 3:40". Empty without time stamps.
std::string log_time_text(const std::vector<TimeUs>& stamps_us, std::size_t scan);

/// Time in seconds to replay the log after `mapped` scans at `speed`, a multiple of the recorded speed.
/// Returns 0 for speed 0, which is as fast as possible, and if `mapped` is 0.
double replay_time_left_s(const std::vector<TimeUs>& stamps_us, std::size_t mapped, double speed);

/// Describes the phase of the run and its remaining time. While scans are mapped, the remaining time is at
/// least `waiting_left_s`.
std::string progress_words(const ReplaySnapshot& snapshot, double waiting_left_s);

}  // namespace psi_slam
