// SPDX-License-Identifier: BSD-3-Clause
#include "legend_picture.h"

#include <mrpt/gui/WxUtils.h>
#include <wx/bitmap.h>
#include <wx/dcmemory.h>
#include <wx/graphics.h>
#include <wx/image.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr double kMargin = 7;  // sizes in pixels at 100 % scaling
constexpr double kStroke = 18;
constexpr double kStrokeWidth = 3;
constexpr double kGap = 6;
const wxColour kPaper(255, 255, 255);
const wxColour kInk(40, 44, 52);
const wxColour kBorder(190, 194, 200);

struct TextSize {
  double width = 0;
  double height = 0;
};

TextSize size_of(wxGraphicsContext& context, const wxString& text) {
  TextSize size;
  context.GetTextExtent(text, &size.width, &size.height);
  return size;
}

void draw(wxGraphicsContext& context, const LoopLegend& legend, const wxFont& font, const wxSize& size) {
  context.SetPen(wxPen(kBorder));
  context.SetBrush(wxBrush(kPaper));
  context.DrawRectangle(0, 0, size.x - 1, size.y - 1);
  context.SetFont(font.Bold(), kInk);
  context.DrawText(text_of(legend.title), kMargin, kMargin);
  double y = kMargin + size_of(context, text_of(legend.title)).height;
  context.SetFont(font, kInk);
  for (const LoopLegend::Entry& entry : legend.entries) {
    const double height = size_of(context, text_of(entry.name)).height;
    context.SetPen(wxPen(colour_of(entry.colour), static_cast<int>(kStrokeWidth)));
    context.StrokeLine(kMargin, y + height / 2, kMargin + kStroke, y + height / 2);
    context.DrawText(text_of(entry.name), kMargin + kStroke + kGap, y);
    y += height;
  }
}

wxSize size_for(wxGraphicsContext& context, const LoopLegend& legend, const wxFont& font) {
  context.SetFont(font.Bold(), kInk);
  TextSize all = size_of(context, text_of(legend.title));
  context.SetFont(font, kInk);
  for (const LoopLegend::Entry& entry : legend.entries) {
    const TextSize text = size_of(context, text_of(entry.name));
    all.width = std::max(all.width, kStroke + kGap + text.width);
    all.height += text.height;
  }
  return {static_cast<int>(std::ceil(all.width + 2 * kMargin)),
          static_cast<int>(std::ceil(all.height + 2 * kMargin))};
}

}  // namespace

mrpt::img::CImage legend_picture(const LoopLegend& legend, const wxWindow& window) {
  if (legend.entries.empty()) return {};
  const double scale = window.GetContentScaleFactor();
  const wxFont font = window.GetFont().Smaller();
  const std::unique_ptr<wxGraphicsContext> ruler(wxGraphicsContext::Create());
  const wxSize size = size_for(*ruler, legend, font);
  wxBitmap bitmap(size * scale, 24);
  {
    wxMemoryDC dc(bitmap);
    dc.SetBackground(wxBrush(kPaper));
    dc.Clear();
    const std::unique_ptr<wxGraphicsContext> context(wxGraphicsContext::Create(dc));
    context->Scale(scale, scale);
    draw(*context, legend, font, size);
  }
  return *mrpt::gui::wxImage2MRPTImagePtr(bitmap.ConvertToImage());
}

}  // namespace psi_slam
