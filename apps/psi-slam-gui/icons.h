// SPDX-License-Identifier: BSD-3-Clause
// The program's own icons, drawn as lines and shapes: sharp at every scaling, whatever icon theme is
// installed.
#pragma once

#include <wx/bmpbndl.h>
#include <wx/colour.h>

namespace psi_slam {

enum class Icon {
  kOpen,
  kPlay,
  kPause,
  kStep,
  kFinish,
  kExport,
  kRestart,
  kFit,
  kTop,
  kFollow,
  kMeasure,
  kNote,
  kWarning,
  kError,
  kClose
};

/// 20 pixels a side at 100 %.
wxBitmapBundle icon_of(Icon icon, const wxColour& colour);

/// Of windows and the About box.
wxBitmapBundle program_icon();

}  // namespace psi_slam
