// SPDX-License-Identifier: BSD-3-Clause
// The run's curves, as it goes: Psi with its thresholds and the matcher in use, response, loops, time a scan
// by stage. A click shows the scan there.
#pragma once

#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "plot_series.h"

class wxGraphicsContext;

namespace psi_slam {

class PlotPanel : public wxPanel {
 public:
  PlotPanel(wxWindow* parent, std::function<void(std::size_t)> go_to);

  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot, std::optional<std::size_t> frame);
  void show_nothing();

 private:
  struct Curve {
    wxString name;
    wxColour colour;
    std::function<double(const PlotColumn&)> value;
  };
  void paint();
  wxRect strip(int index, const wxSize& size) const;
  void draw_psi(wxGraphicsContext& context, const wxRect& area) const;
  void draw_response(wxGraphicsContext& context, const wxRect& area) const;
  void draw_loops(wxGraphicsContext& context, const wxRect& area) const;
  void draw_times(wxGraphicsContext& context, const wxRect& area) const;
  void draw_axes(wxGraphicsContext& context, const wxRect& area, const wxString& title, double top) const;
  void draw_curve(wxGraphicsContext& context, const wxRect& area, double top, const Curve& curve) const;
  void draw_legend(wxGraphicsContext& context, const wxRect& area, const std::vector<Curve>& curves) const;
  void draw_matchers(wxGraphicsContext& context, const wxRect& area) const;
  double x_of(const wxRect& area, double frame) const;

  std::function<void(std::size_t)> go_to_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<std::size_t> frame_;
  std::vector<PlotColumn> columns_;
};

}  // namespace psi_slam
