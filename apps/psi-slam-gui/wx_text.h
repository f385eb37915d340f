// SPDX-License-Identifier: BSD-3-Clause
// Between the libraries' values and wx's.
#pragma once

#include <mrpt/img/TColor.h>
#include <wx/colour.h>
#include <wx/string.h>

#include <filesystem>
#include <string>

namespace psi_slam {

inline wxColour colour_of(const mrpt::img::TColor& colour) {
  return {colour.R, colour.G, colour.B, colour.A};
}

inline wxString text_of(const std::string& utf8) {
  return wxString::FromUTF8(utf8);
}

/// File names are bytes; what is no UTF-8 of them is kept as it is where wx can.
inline std::filesystem::path path_of(const wxString& text) {
  return std::filesystem::path(text.fn_str().data());
}
inline wxString text_of(const std::filesystem::path& path) {
  return wxString(path.c_str(), wxConvFile);
}

}  // namespace psi_slam
