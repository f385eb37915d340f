// SPDX-License-Identifier: BSD-3-Clause
// Icons of the program as vector graphics: sharp at every scaling and independent of icon themes.
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
  kMapEdits,
  kNote,
  kWarning,
  kError,
  kClose,
};

/// An icon of 20 x 20 pixels at 100 % scaling.
wxBitmapBundle icon_of(Icon icon, const wxColour& colour);

/// The icon of windows and of the About box.
wxBitmapBundle program_icon();

}  // namespace psi_slam
