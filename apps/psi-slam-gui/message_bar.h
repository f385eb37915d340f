// SPDX-License-Identifier: BSD-3-Clause
// Sentences for the user in a bar above the map, which never stop what he is doing.
#pragma once

#include <wx/panel.h>

#include <functional>
#include <string>
#include <vector>

class wxBoxSizer;
class wxBitmapButton;
class wxStaticBitmap;
class wxStaticText;

namespace psi_slam {

class MessageBar : public wxPanel {
 public:
  enum class Kind { kNote, kWarning, kError };
  struct Answer {
    std::string label;
    std::function<void()> action;  ///< the bar has gone by then
  };

  explicit MessageBar(wxWindow* parent);

  /// Replaces what was shown before.
  void say(Kind kind, const std::string& sentence, const std::vector<Answer>& answers = {});
  /// The sentence on show; "" when there is none.
  std::string sentence() const { return IsShown() ? sentence_ : std::string(); }
  /// Whether there is something to be answered.
  bool asks() const { return IsShown() && !answers_.empty(); }
  /// Does what a click on the answer does. False when there is no answer of that label.
  bool answer(const std::string& label);
  void dismiss();

 private:
  void wrap();

  std::string sentence_;
  int wrapped_for_ = -1;  // the width of the bar
  std::vector<Answer> answers_;
  wxBoxSizer* buttons_;
  wxStaticBitmap* icon_;
  wxStaticText* text_;
  wxBitmapButton* close_;
};

}  // namespace psi_slam
