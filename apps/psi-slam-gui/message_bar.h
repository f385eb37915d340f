// SPDX-License-Identifier: BSD-3-Clause
// Sentences for the user in a bar above the map, which never stop what he is doing.
#pragma once

#include <wx/infobar.h>

#include <functional>
#include <string>
#include <vector>

namespace psi_slam {

class MessageBar : public wxInfoBar {
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
  /// Does what a click on the answer does. False when there is no answer of that label.
  bool answer(const std::string& label);

 private:
  void clear_answers();

  std::string sentence_;
  std::vector<Answer> answers_;
};

}  // namespace psi_slam
