// SPDX-License-Identifier: BSD-3-Clause
// Which files the user wants: asked by the desktop's dialogs, or answered by whoever drives the window
// without a person.
#pragma once

#include <wx/window.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace psi_slam {

struct FileQuestion {
  enum class Kind { kOpen, kSave, kFolder };
  Kind kind = Kind::kOpen;
  std::string title;
  std::string kinds_of_files;  ///< as wx's wildcards
  std::string proposed_name;
};

/// The file or folder, or none when the user thinks better of it. One to be saved to may exist: the user has
/// agreed to replace it then.
using AskForFile = std::function<std::optional<std::filesystem::path>(const FileQuestion&)>;

/// By the desktop's dialogs.
AskForFile ask_in_dialogs(wxWindow& parent);

}  // namespace psi_slam
