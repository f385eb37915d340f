// SPDX-License-Identifier: BSD-3-Clause
#include "icons.h"

#include <array>

namespace psi_slam {
namespace {

constexpr int kSide = 20;
constexpr int kProgramSide = 64;

/// SVG shapes of each Icon, in a square of 20 x 20. INK stands for the colour, LINE for the style of strokes.
constexpr std::array<const char*, 16> kShapes{
    R"(<path d="M2.5 16V4.5H8l2 2.5h7.5v9z" LINE/>)",
    R"(<path d="M5 3l12 7-12 7z" fill="INK"/>)",
    R"(<path d="M4.5 3h4v14h-4zM11.5 3h4v14h-4z" fill="INK"/>)",
    R"(<path d="M4 3l9 7-9 7zM14 3h2.5v14H14z" fill="INK"/>)",
    R"(<path d="M5 18V2.5M5 3h11l-3 4 3 4H5" LINE/>)",
    R"(<path d="M10 2.5v9.5M6 8.5l4 4 4-4M3 13v4h14v-4" LINE/>)",
    R"(<path d="M15.5 6.5A6.5 6.5 0 1 0 16.5 11M16.5 2.5v4.5h-4.5" LINE/>)",
    R"(<path d="M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M8 8h4v4H8z" LINE/>)",
    R"(<path d="M3 13l7-4 7 4-7 4zM10 1.5V7M8 5l2 2.2L12 5" LINE/>)",
    R"(<path d="M10 2l6 15-6-4-6 4z" LINE/>)",
    R"(<path d="M2.5 13.5l11-11 4 4-11 11zM5.5 10.5l2 2M8.5 7.5l2 2M11.5 4.5l2 2" LINE/>)",
    R"(<path d="M2.5 16.5l1-4.5 8.5-8.5 3.5 3.5-8.5 8.5zM10 17h7.5" LINE/>)",
    R"(<circle cx="10" cy="10" r="7.5" LINE/><path d="M10 9v5M10 6.2v.1" LINE/>)",
    R"(<path d="M10 2.5l8 14.5H2zM10 8v4.5M10 14.8v.1" LINE/>)",
    R"(<circle cx="10" cy="10" r="7.5" LINE/><path d="M7 7l6 6M13 7l-6 6" LINE/>)",
    R"(<path d="M5.5 5.5l9 9M14.5 5.5l-9 9" LINE/>)"};

wxBitmapBundle bundle_of(const wxString& shapes, const wxString& ink, int side) {
  wxString svg = R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 20">)" + shapes + "</svg>";
  svg.Replace(
      "LINE",
      R"(fill="none" stroke="INK" stroke-width="1.8" stroke-linecap="round" stroke-linejoin="round")");
  svg.Replace("INK", ink);
  return wxBitmapBundle::FromSVG(svg.utf8_string().c_str(), wxSize(side, side));
}

}  // namespace

wxBitmapBundle icon_of(Icon icon, const wxColour& colour) {
  return bundle_of(kShapes.at(static_cast<std::size_t>(icon)), colour.GetAsString(wxC2S_HTML_SYNTAX), kSide);
}

wxBitmapBundle program_icon() {
  return bundle_of(R"(<rect x="0.5" y="0.5" width="19" height="19" rx="4" fill="INK"/>)"
                   R"(<path d="M5 4.5v3.2c0 2.9 2 4.3 5 4.3s5-1.4 5-4.3V4.5M10 3.5v13" fill="none" )"
                   R"(stroke="#ffffff" stroke-width="2" stroke-linecap="round"/>)",
                   "#1f61ab", kProgramSide);
}

}  // namespace psi_slam
