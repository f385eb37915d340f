// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/bitmap.h>
#include <wx/panel.h>

#include <optional>

#include "gui/loop_picture.h"

namespace psi_slam {

/// Picture of a loop: its scan on its local map at the predicted pose (left) and at the matched pose (right).
class LoopCanvas : public wxPanel {
 public:
  explicit LoopCanvas(wxWindow* parent);

  /// Shows `picture`, or a hint if it is empty.
  void show(std::optional<LoopPicture> picture);
  bool empty() const { return !picture_; }

 private:
  void paint();

  std::optional<LoopPicture> picture_;
  wxBitmap local_map_;
};

}  // namespace psi_slam
