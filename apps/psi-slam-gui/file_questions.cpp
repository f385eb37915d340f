// SPDX-License-Identifier: BSD-3-Clause
#include "file_questions.h"

#include <wx/dirdlg.h>
#include <wx/filedlg.h>

#include "wx_text.h"

namespace psi_slam {

AskForFile ask_in_dialogs(wxWindow& parent) {
  return [&parent](const FileQuestion& question) -> std::optional<std::filesystem::path> {
    if (question.kind == FileQuestion::Kind::kFolder) {
      wxDirDialog dialog(&parent, text_of(question.title));
      if (dialog.ShowModal() != wxID_OK) return std::nullopt;
      return path_of(dialog.GetPath());
    }
    const bool saves = question.kind == FileQuestion::Kind::kSave;
    wxFileDialog dialog(&parent, text_of(question.title), "", text_of(question.proposed_name),
                        text_of(question.kinds_of_files),
                        saves ? wxFD_SAVE | wxFD_OVERWRITE_PROMPT : wxFD_OPEN | wxFD_FILE_MUST_EXIST);
    if (dialog.ShowModal() != wxID_OK) return std::nullopt;
    return path_of(dialog.GetPath());
  };
}

}  // namespace psi_slam
