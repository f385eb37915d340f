// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/panel.h>

#include <functional>

namespace psi_slam {

/// What stands where the map will be, as long as no log is open: what to do.
class EmptyState : public wxPanel {
 public:
  EmptyState(wxWindow* parent, const std::function<void()>& open);
};

}  // namespace psi_slam
