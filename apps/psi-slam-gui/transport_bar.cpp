// SPDX-License-Identifier: BSD-3-Clause
#include "transport_bar.h"

#include <wx/bmpbuttn.h>
#include <wx/settings.h>
#include <wx/sizer.h>
#include <wx/slider.h>
#include <wx/stattext.h>

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "icons.h"
#include "main_menu.h"
#include "progress_line.h"

namespace psi_slam {
namespace {

wxBitmapButton* button(wxWindow* parent, Icon icon, const char* tip, int command) {
  const wxColour ink = wxSystemSettings::GetColour(wxSYS_COLOUR_BTNTEXT);
  auto* made = new wxBitmapButton(parent, wxID_ANY, icon_of(icon, ink));
  made->SetToolTip(tip);
  made->Bind(wxEVT_BUTTON, [parent, command](wxCommandEvent&) { choose_command(*parent, command); });
  return made;
}

}  // namespace

TransportBar::TransportBar(wxWindow* parent, const std::function<void(std::size_t)>& go_to)
    : wxPanel(parent) {
  play_ = button(this, Icon::kPlay, "Play or pause (Space)", kPlayOrPause);
  play_->SetName("play");
  step_ = button(this, Icon::kStep, "Map one more scan (.)", kStep);
  finish_ = button(this, Icon::kFinish,
                   "Stop reading the log or the live source, and finish the map (Ctrl+Return)", kFinish);
  speed_ = new wxChoice(this, wxID_ANY);
  speed_->SetToolTip("Speed of the replay, as a multiple of the recorded speed");
  for (const double speed : kSpeeds) speed_->Append(speed_text(speed));
  speed_->SetSelection(static_cast<int>(kSpeeds.size()) - 1);
  speed_->Bind(wxEVT_CHOICE,
               [this](wxCommandEvent&) { choose_command(*this, kSpeed + speed_->GetSelection()); });
  slider_ = new wxSlider(this, wxID_ANY, 0, 0, 1);
  slider_->SetToolTip("Drag back to show an earlier scan, forward to map up to a later scan");
  const auto dragged = [this, go_to](wxScrollEvent&) {
    go_to(static_cast<std::size_t>(slider_->GetValue()));
  };
  slider_->Bind(wxEVT_SCROLL_THUMBRELEASE, dragged);
  slider_->Bind(wxEVT_SCROLL_CHANGED, dragged);
  time_ = new wxStaticText(this, wxID_ANY, "");
  progress_ = new wxStaticText(this, wxID_ANY, "No log is open");

  auto* row = new wxBoxSizer(wxHORIZONTAL);
  const int gap = FromDIP(4);
  for (wxWindow* left : std::initializer_list<wxWindow*>{play_, step_, finish_, speed_})
    row->Add(left, 0, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  row->Add(slider_, 1, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  row->Add(time_, 0, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  auto* column = new wxBoxSizer(wxVERTICAL);
  column->Add(row, 0, wxEXPAND);
  column->Add(progress_, 0, wxEXPAND | wxLEFT | wxRIGHT | wxBOTTOM, 2 * gap);
  SetSizer(column);
  for (wxWindow* child : std::initializer_list<wxWindow*>{play_, step_, finish_, slider_}) child->Disable();
}

void TransportBar::show(const ReplaySnapshot& snapshot,
                        const std::shared_ptr<const std::vector<TimeUs>>& stamps_us,
                        std::optional<std::size_t> shown) {
  const bool mapping = snapshot.phase == ReplayPhase::kPaused || snapshot.phase == ReplayPhase::kPlaying;
  const bool replays = !snapshot.live && (mapping || snapshot.phase == ReplayPhase::kOpening);
  const bool final_search = snapshot.phase == ReplayPhase::kFinalSearch;
  play_->Enable(replays || final_search);
  step_->Enable(replays && mapping);
  finish_->Enable((mapping && (snapshot.live || !snapshot.frames.empty())) || final_search);
  speed_->Enable(!snapshot.live);
  slider_->Enable((replays && mapping) || !snapshot.frames.empty());
  if (const bool plays = can_pause(snapshot); plays != std::exchange(plays_, plays))
    play_->SetBitmap(
        icon_of(plays ? Icon::kPause : Icon::kPlay, wxSystemSettings::GetColour(wxSYS_COLOUR_BTNTEXT)));
  const std::size_t mapped = snapshot.frames.size();
  const std::size_t count = stamps_us ? std::max(stamps_us->size(), mapped) : mapped;
  const std::size_t at = shown.value_or(mapped == 0 ? 0 : mapped - 1);
  const int last = std::max(1, static_cast<int>(count) - 1);
  if (slider_->GetMax() != last) slider_->SetRange(0, last);
  const bool dragged = slider_->HasCapture() || wxGetMouseState().LeftIsDown();
  if (!dragged) slider_->SetValue(std::min(static_cast<int>(at), last));
  const std::string time = stamps_us ? log_time_text(*stamps_us, at) : std::string();
  if (time_->GetLabel() != time) {
    time_->SetLabel(time);
    Layout();
  }
  const double speed = kSpeeds.at(static_cast<std::size_t>(speed_->GetSelection()));
  std::string words = progress_words(snapshot, stamps_us ? replay_time_left_s(*stamps_us, mapped, speed) : 0);
  if (shown) words += "   (showing scan " + std::to_string(*shown + 1) + ")";
  const wxString label = wxString::FromUTF8(words);
  if (progress_->GetLabel() != label) progress_->SetLabel(label);
}

bool TransportBar::can_pause(const ReplaySnapshot& snapshot) {
  return snapshot.phase == ReplayPhase::kPlaying ||
         (snapshot.phase == ReplayPhase::kFinalSearch && !snapshot.final_search_held);
}

std::string log_time_text(const std::vector<TimeUs>& stamps_us, std::size_t scan) {
  if (stamps_us.empty()) return "";
  const auto since = [&](std::size_t index) {
    return minutes_text(
        std::max(0.0, seconds(stamps_us[std::min(index, stamps_us.size() - 1)] - stamps_us[0])));
  };
  return since(scan) + " of " + since(stamps_us.size() - 1);
}

double replay_time_left_s(const std::vector<TimeUs>& stamps_us, std::size_t mapped, double speed) {
  if (speed <= 0 || mapped == 0 || mapped >= stamps_us.size()) return 0;
  return std::max(0.0, seconds(stamps_us.back() - stamps_us[mapped - 1])) / speed;
}

std::string progress_words(const ReplaySnapshot& snapshot, double waiting_left_s) {
  const std::string unmatched = std::to_string(snapshot.unmatched->count) + " not matched";
  const bool all_matched = snapshot.unmatched->count == 0;
  const std::string scans =
      std::to_string(snapshot.frames.size()) + " scans" + (all_matched ? "" : ", " + unmatched);
  switch (snapshot.phase) {
    case ReplayPhase::kOpening:
      return snapshot.live ? "Connecting" : "Opening the log";
    case ReplayPhase::kPaused:
      return snapshot.frames.empty() ? "Ready. Press play." : "Paused after " + scans;
    case ReplayPhase::kPlaying: {
      if (snapshot.live) return snapshot.frames.empty() ? "Waiting for scans" : "Mapping live: " + scans;
      SessionProgress progress = snapshot.progress;
      if (waiting_left_s > 0)
        progress.remaining_s = std::max(waiting_left_s, progress.remaining_s.value_or(0));
      return "Mapping: " + progress_text(progress) + (all_matched ? "" : "   " + unmatched);
    }
    case ReplayPhase::kFinalSearch:
      return (snapshot.final_search_held ? "Finishing, paused: " : "Finishing: ") +
             progress_text(snapshot.progress);
    case ReplayPhase::kFinished:
      return "Map finished: " + scans + (snapshot.interrupted ? ", stopped before the end of the log" : "");
    case ReplayPhase::kExporting:
      return "Writing the results";
    case ReplayPhase::kFailed:
      return "Stopped after a failure: see the message above the map";
  }
  return "";
}

}  // namespace psi_slam
