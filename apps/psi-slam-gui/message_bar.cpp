// SPDX-License-Identifier: BSD-3-Clause
#include "message_bar.h"

#include <wx/bmpbuttn.h>
#include <wx/sizer.h>
#include <wx/statbmp.h>
#include <wx/stattext.h>

#include <algorithm>
#include <array>

#include "icons.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kGap = 6;
constexpr int kNarrowest = 120;  // least width of the text
const wxColour kInk(40, 44, 52);

struct Look {
  Icon icon;
  wxColour paper;
  wxColour ink;  // colour of the icon
};

/// Icon and colours of each MessageBar::Kind.
const std::array<Look, 3> kLooks{{{Icon::kNote, {222, 235, 250}, {31, 97, 171}},
                                  {Icon::kWarning, {253, 240, 208}, {176, 112, 0}},
                                  {Icon::kError, {251, 224, 222}, {196, 30, 40}}}};

}  // namespace

MessageBar::MessageBar(wxWindow* parent) : wxPanel(parent) {
  SetName("messages");
  icon_ = new wxStaticBitmap(this, wxID_ANY, icon_of(Icon::kNote, kInk));
  text_ = new wxStaticText(this, wxID_ANY, "");
  text_->SetForegroundColour(kInk);
  close_ = new wxBitmapButton(this, wxID_ANY, icon_of(Icon::kClose, kInk), wxDefaultPosition, wxDefaultSize,
                              wxBORDER_NONE);
  close_->SetName("dismiss");
  close_->SetToolTip("Close this message");
  close_->Bind(wxEVT_BUTTON, [this](wxCommandEvent&) { dismiss(); });
  buttons_ = new wxBoxSizer(wxHORIZONTAL);
  auto* row = new wxBoxSizer(wxHORIZONTAL);
  const int gap = FromDIP(kGap);
  row->Add(icon_, 0, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  row->Add(text_, 1, wxALIGN_CENTRE_VERTICAL | wxTOP | wxBOTTOM, gap);
  row->Add(buttons_, 0, wxALIGN_CENTRE_VERTICAL | wxLEFT, gap);
  row->Add(close_, 0, wxALIGN_CENTRE_VERTICAL | wxRIGHT, gap);
  SetSizer(row);
  Hide();
  Bind(wxEVT_SIZE, [this](wxSizeEvent& event) {
    event.Skip();
    if (IsShown() && event.GetSize().GetWidth() != wrapped_for_) CallAfter([this] { wrap(); });
  });
}

void MessageBar::say(Kind kind, const std::string& sentence, const std::vector<Answer>& answers) {
  sentence_ = sentence;
  answers_ = answers;
  const Look& look = kLooks.at(static_cast<std::size_t>(kind));
  SetBackgroundColour(look.paper);
  icon_->SetBitmap(icon_of(look.icon, look.ink));
  buttons_->Clear(true);
  for (const Answer& answer : answers_) {
    auto* button = new wxButton(this, wxID_ANY, text_of(answer.label));
    button->Bind(wxEVT_BUTTON, [this, label = answer.label](wxCommandEvent&) {
      CallAfter([this, label] { this->answer(label); });  // the answer may delete this button
    });
    buttons_->Add(button, 0, wxRIGHT, FromDIP(kGap));
  }
  Show();
  wrap();
  Refresh();
}

/// Wraps the text to the width between icon and buttons.
void MessageBar::wrap() {
  wrapped_for_ = GetParent()->GetClientSize().GetWidth();
  const int beside = icon_->GetBestSize().GetWidth() + buttons_->CalcMin().GetWidth() +
                     close_->GetBestSize().GetWidth() + 5 * FromDIP(kGap);
  text_->SetLabelText(text_of(sentence_));
  text_->Wrap(std::max(FromDIP(kNarrowest), wrapped_for_ - beside));
  GetParent()->Layout();
}

bool MessageBar::answer(const std::string& label) {
  for (const Answer& answer : answers_) {
    if (answer.label != label) continue;
    const std::function<void()> action = answer.action;
    dismiss();
    action();
    return true;
  }
  return false;
}

void MessageBar::dismiss() {
  if (!IsShown()) return;
  answers_.clear();
  Hide();
  GetParent()->Layout();
}

std::string first_sentences(const std::vector<std::string>& sentences) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < sentences.size() && i < kMost; ++i) text += (i == 0 ? "" : "\n") + sentences[i];
  if (sentences.size() > kMost) text += "\nand " + std::to_string(sentences.size() - kMost) + " more";
  return text;
}

}  // namespace psi_slam
