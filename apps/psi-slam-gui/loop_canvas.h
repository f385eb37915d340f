// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/bitmap.h>
#include <wx/panel.h>

#include <optional>

#include "view/loop_picture.h"

class wxGraphicsContext;

namespace psi_slam {

/// The scan of a loop over its local map, as predicted and as matched, side by side.
class LoopCanvas : public wxPanel {
 public:
  explicit LoopCanvas(wxWindow* parent);

  /// None: says what to do to see something.
  void show(std::optional<LoopPicture> picture);
  bool empty() const { return !picture_; }

 private:
  void paint();
  void draw_half(wxGraphicsContext& context, const wxRect& area,
                 const std::vector<mrpt::math::TPoint2D>& scan, const wxColour& colour,
                 const wxString& title) const;

  std::optional<LoopPicture> picture_;
  wxBitmap local_map_;
};

}  // namespace psi_slam
