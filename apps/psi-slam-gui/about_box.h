// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/aboutdlg.h>

namespace psi_slam {

wxAboutDialogInfo about_info();

}  // namespace psi_slam
