// SPDX-License-Identifier: BSD-3-Clause
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

/// Bar above the map for messages and questions. The user can ignore it and go on working.
class MessageBar : public wxPanel {
 public:
  enum class Kind { kNote, kWarning, kError };
  struct Answer {
    std::string label;
    std::function<void()> action;  ///< called after the bar is hidden
  };

  explicit MessageBar(wxWindow* parent);

  /// Shows a sentence with a button for each answer, in place of the previous message.
  void say(Kind kind, const std::string& sentence, const std::vector<Answer>& answers = {});
  void note(const std::string& sentence) { say(Kind::kNote, sentence); }
  void warn(const std::string& sentence, const std::vector<Answer>& answers = {}) {
    say(Kind::kWarning, sentence, answers);
  }
  void fail(const std::string& sentence) { say(Kind::kError, sentence); }
  /// The sentence that the bar shows; empty while the bar is hidden.
  std::string sentence() const { return IsShown() ? sentence_ : std::string(); }
  /// True while a question waits for an answer.
  bool asks() const { return IsShown() && !answers_.empty(); }
  /// Gives the answer with this label, like a click on its button. Returns false if there is no such answer.
  bool answer(const std::string& label);
  void dismiss();

 private:
  void wrap();

  std::string sentence_;
  int wrapped_for_ = -1;  // width of the bar that the text is wrapped for, in pixels
  std::vector<Answer> answers_;
  wxBoxSizer* buttons_;
  wxStaticBitmap* icon_;
  wxStaticText* text_;
  wxBitmapButton* close_;
};

/// The first four sentences, one per line, and the number of further sentences.
std::string first_sentences(const std::vector<std::string>& sentences);

}  // namespace psi_slam
