// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_dxf.h"

#include <utility>

#include "base/number_text.h"

namespace psi_slam {
namespace {

constexpr const char* kWalls = "WALLS";
constexpr const char* kTrajectory = "TRAJECTORY";

/// A DXF file is pairs of lines: what the value means, and the value.
class DxfText {
 public:
  DxfText& pair(int code, const std::string& value) {
    text_ += std::to_string(code) + '\n' + value + '\n';
    return *this;
  }
  DxfText& pair(int code, int value) { return pair(code, std::to_string(value)); }
  /// x and y under `code` and the code for y, which is ten more.
  DxfText& point(double x, double y, int code = 10) {
    return pair(code, fixed_text(x, 4)).pair(code + 10, fixed_text(y, 4)).pair(code + 20, "0.0");
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

void write_header(DxfText& dxf, const DrawingExtent& extent) {
  dxf.pair(999, "Floor plan by psi-slam; one unit is a metre");
  dxf.pair(0, "SECTION").pair(2, "HEADER").pair(9, "$ACADVER").pair(1, "AC1009");
  dxf.pair(9, "$EXTMIN").point(extent.x_min_m, extent.y_min_m);
  dxf.pair(9, "$EXTMAX").point(extent.x_max_m, extent.y_max_m);
  dxf.pair(0, "ENDSEC");
}

void write_tables(DxfText& dxf) {
  constexpr int kForeground = 7;
  constexpr int kRed = 1;
  dxf.pair(0, "SECTION").pair(2, "TABLES");
  dxf.pair(0, "TABLE").pair(2, "LTYPE").pair(70, 1);
  dxf.pair(0, "LTYPE").pair(2, "CONTINUOUS").pair(70, 0).pair(3, "Solid line");
  dxf.pair(72, 65).pair(73, 0).pair(40, "0.0").pair(0, "ENDTAB");
  dxf.pair(0, "TABLE").pair(2, "LAYER").pair(70, 3);
  const std::pair<const char*, int> layers[] = {
      {"0", kForeground}, {kWalls, kForeground}, {kTrajectory, kRed}};
  for (const auto& [name, colour] : layers)
    dxf.pair(0, "LAYER").pair(2, name).pair(70, 0).pair(62, colour).pair(6, "CONTINUOUS");
  dxf.pair(0, "ENDTAB").pair(0, "ENDSEC");
}

void write_line(DxfText& dxf, const MapLine& line, const char* layer, bool closed) {
  if (line.size() < 2) return;
  if (line.size() == 2) {
    dxf.pair(0, "LINE").pair(8, layer).point(line[0].x, line[0].y).point(line[1].x, line[1].y, 11);
    return;
  }
  dxf.pair(0, "POLYLINE").pair(8, layer).pair(66, 1).point(0, 0).pair(70, closed ? 1 : 0);
  for (const auto& point : line) dxf.pair(0, "VERTEX").pair(8, layer).point(point.x, point.y);
  dxf.pair(0, "SEQEND").pair(8, layer);
}

}  // namespace

std::string map_dxf(const MapDrawing& drawing) {
  DxfText dxf;
  write_header(dxf, drawing.extent);
  write_tables(dxf);
  dxf.pair(0, "SECTION").pair(2, "ENTITIES");
  for (const MapLine& wall : drawing.walls) write_line(dxf, wall, kWalls, true);
  for (const MapLine& line : drawing.trajectories) write_line(dxf, line, kTrajectory, false);
  dxf.pair(0, "ENDSEC").pair(0, "EOF");
  return dxf.take();
}

}  // namespace psi_slam
