// SPDX-License-Identifier: BSD-3-Clause
#include "message_bar.h"

#include <wx/artprov.h>
#include <wx/sizer.h>

namespace psi_slam {
namespace {

constexpr int kFirstAnswer = wxID_HIGHEST + 700;

int flags_of(MessageBar::Kind kind) {
  switch (kind) {
    case MessageBar::Kind::kNote:
      return wxICON_INFORMATION;
    case MessageBar::Kind::kWarning:
      return wxICON_WARNING;
    case MessageBar::Kind::kError:
      return wxICON_ERROR;
  }
  return wxICON_NONE;
}

}  // namespace

MessageBar::MessageBar(wxWindow* parent) : wxInfoBar(parent) {
  SetName("messages");
  Bind(wxEVT_BUTTON, [this](wxCommandEvent& event) {
    const auto index = static_cast<std::size_t>(event.GetId() - kFirstAnswer);
    if (index < answers_.size())
      answer(std::string(answers_[index].label));
    else
      event.Skip();
  });
}

void MessageBar::say(Kind kind, const std::string& sentence, const std::vector<Answer>& answers) {
  clear_answers();
  sentence_ = sentence;
  for (const Answer& answer : answers) {
    AddButton(kFirstAnswer + static_cast<int>(answers_.size()), wxString::FromUTF8(answer.label));
    answers_.push_back(answer);
  }
  if (!answers_.empty()) AddButton(wxID_CLOSE, "Not now");
  ShowMessage(wxString::FromUTF8(sentence), flags_of(kind));
}

bool MessageBar::answer(const std::string& label) {
  for (const Answer& answer : answers_) {
    if (answer.label != label) continue;
    const std::function<void()> action = answer.action;
    Dismiss();
    action();
    return true;
  }
  return false;
}

void MessageBar::clear_answers() {
  for (std::size_t i = 0; i < answers_.size(); ++i) RemoveButton(kFirstAnswer + static_cast<int>(i));
  if (!answers_.empty()) RemoveButton(wxID_CLOSE);
  answers_.clear();
}

}  // namespace psi_slam
