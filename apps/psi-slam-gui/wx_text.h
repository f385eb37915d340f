// SPDX-License-Identifier: BSD-3-Clause
// Conversions between the libraries' types and wxWidgets' types.
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

/// Converts a file name of wxWidgets to a path. Keeps bytes that are not UTF-8 if wxWidgets can.
inline std::filesystem::path path_of(const wxString& text) {
  return std::filesystem::path(text.fn_str().data());
}
inline wxString text_of(const std::filesystem::path& path) {
  return wxString(path.c_str(), wxConvFile);
}

}  // namespace psi_slam
