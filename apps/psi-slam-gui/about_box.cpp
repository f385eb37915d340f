// SPDX-License-Identifier: BSD-3-Clause
#include "about_box.h"

#include <mrpt/system/os.h>
#include <wx/version.h>

#include "icons.h"

namespace psi_slam {

wxAboutDialogInfo about_info() {
  wxAboutDialogInfo info;
  info.SetName("psi-slam");
  info.SetVersion(PSI_SLAM_VERSION);
  const wxString what = wxString::FromUTF8(
      "Floor plans from the scans of a 2D lidar and wheel odometry:\n"
      "graph SLAM with genetic loop matching, and the factor \xCE\xA8 that picks the matcher.\n\n"
      "Built with ");
  info.SetDescription(what + wxString::FromUTF8(mrpt::system::MRPT_getVersion()) + " and " +
                      wxString(wxVERSION_STRING) + ".");
  info.SetLicence("BSD 3-Clause");
  info.SetIcon(program_icon().GetIcon(wxSize(64, 64)));
  return info;
}

}  // namespace psi_slam
