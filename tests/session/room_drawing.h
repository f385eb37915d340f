// SPDX-License-Identifier: BSD-3-Clause
// A floor plan of the room of room_log.h as a drawing.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

namespace psi_slam {

/// Place of the room's origin in the drawing.
inline constexpr double kRoomDrawingShift_m = 0.02;

/// A DXF drawing of the room in millimetres, on the layer WALLS. A diagonal across the room is on DIMENSIONS.
inline std::string room_drawing(const std::string& header) {
  std::string dxf = header + "0\nSECTION\n2\nENTITIES\n";
  const auto add = [&](const std::string& layer, double x0, double y0, double x1, double y1) {
    const auto millimetres = [](double metres) {
      return std::to_string(1000 * (metres + kRoomDrawingShift_m));
    };
    dxf += "0\nLINE\n8\n" + layer + "\n10\n" + millimetres(x0) + "\n20\n" + millimetres(y0) + "\n11\n" +
           millimetres(x1) + "\n21\n" + millimetres(y1) + "\n";
  };
  const std::vector<mrpt::math::TPoint2D> walls{{0, 0},   {12, 0}, {12, 8}, {7, 8}, {7, 9.5},
                                                {4, 9.5}, {4, 8},  {0, 8},  {0, 0}};
  for (std::size_t i = 0; i + 1 < walls.size(); ++i)
    add("WALLS", walls[i].x, walls[i].y, walls[i + 1].x, walls[i + 1].y);
  add("DIMENSIONS", 0, 0, 12, 8);
  return dxf + "0\nENDSEC\n0\nEOF\n";
}

/// The beginning of a drawing in millimetres.
inline const std::string kMillimetres = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n";

}  // namespace psi_slam
