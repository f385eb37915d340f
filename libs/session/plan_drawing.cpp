// SPDX-License-Identifier: BSD-3-Clause
#include "session/plan_drawing.h"

#include <cpl_error.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "base/scope_exit.h"
#include "base/text_parts.h"
#include "localization/reference_map.h"
#include "map/exports/drawing_layers.h"
#include "map/rendering/grid_layout.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using Line = std::vector<TPoint2D>;

constexpr double kMargin_m = 1;  // free space around the drawing
constexpr double kLargest_m = 5000;
// Side of a cell. It does not depend on map.resolution_m, which changes no poses.
constexpr double kLeastCell_m = 0.05;
constexpr double kMostCell_m = 0.2;
constexpr double kMostCells = 100e6;
constexpr double kStepCells = 0.4;  // between points on a line

/// Metres of a unit by its number in $INSUNITS; 0 for numbers without a length that buildings are drawn in.
double metres_of(int unit) {
  constexpr std::array<double, 15> kMetres{0, 0.0254, 0.3048, 0, 0.001, 0.01, 1,  1000,
                                           0, 0,      0.9144, 0, 0,     0,    0.1};
  return unit >= 0 && static_cast<std::size_t>(unit) < kMetres.size()
             ? kMetres[static_cast<std::size_t>(unit)]
             : 0;
}

/// Returns the value of $INSUNITS in the header of a text DXF file; 0 if the header lacks it.
int stated_unit(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    const std::string_view text = trimmed(line, " \t\r");
    if (text == "ENDSEC") return 0;
    if (text != "$INSUNITS") continue;
    std::getline(file, line);  // the group code
    int unit = 0;
    return file >> unit ? unit : 0;
  }
  return 0;
}

double metres_per_unit(const std::filesystem::path& path, const PlanDrawingOptions& options) {
  if (options.metres_per_unit) return *options.metres_per_unit;
  const double metres = metres_of(stated_unit(path));
  if (metres == 0)
    throw UserError(path.string() +
                    ": the drawing states no unit of length ($INSUNITS). State it with "
                    "prior.metres_per_unit, such as 0.001 for millimetres");
  return metres;
}

std::set<std::string> names_in(const std::string& list) {
  std::set<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view name = trimmed(std::string_view(list).substr(begin, end - begin));
    if (!name.empty()) names.emplace(name);
    begin = end + 1;
  }
  return names;
}

/// Adds all lines of a geometry, in metres. Points, such as those of texts, have none.
void add_lines(const OGRGeometry& geometry, double scale, std::vector<Line>& lines) {
  if (const auto* collection = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
    for (const OGRGeometry* part : *collection) add_lines(*part, scale, lines);
  } else if (const auto* polygon = dynamic_cast<const OGRPolygon*>(&geometry)) {
    for (const OGRLinearRing* ring : *polygon) add_lines(*ring, scale, lines);
  } else if (const auto* curve = dynamic_cast<const OGRSimpleCurve*>(&geometry)) {
    Line line;
    for (int i = 0; i < curve->getNumPoints(); ++i)
      line.emplace_back(scale * curve->getX(i), scale * curve->getY(i));
    lines.push_back(std::move(line));
  }
}

struct DrawnLines {
  std::vector<Line> lines;          ///< on the layers with walls, in metres
  std::vector<std::string> layers;  ///< names of all layers, sorted
};

DrawnLines lines_of(const std::filesystem::path& path, const PlanDrawingOptions& options) {
  GDALAllRegister();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const ScopeExit restore(&CPLPopErrorHandler);
  constexpr std::array<const char*, 2> kDrivers{"DXF", nullptr};
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open(path.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, kDrivers.data()));
  const std::set<std::string> chosen = names_in(options.layers);
  const auto has_walls = [&](const std::string& layer) {
    return chosen.empty() ? layer != kTrajectoryLayer : chosen.count(layer) != 0;
  };
  std::vector<Line> lines;
  std::set<std::string> layers;
  if (file) {
    const double scale = metres_per_unit(path, options);
    for (OGRLayer* layer : file->GetLayers()) {
      for (const auto& feature : layer) {
        const char* const name = feature->GetFieldAsString("Layer");
        layers.emplace(name);
        const OGRGeometry* const geometry = feature->GetGeometryRef();
        if (geometry == nullptr || !has_walls(name)) continue;
        const std::unique_ptr<OGRGeometry> linear(geometry->getLinearGeometry());
        if (linear) add_lines(*linear, scale, lines);
      }
    }
  }
  if (!file)
    throw UserError(path.string() + " is no readable DXF drawing. Export the plan as DXF in text form");
  for (const std::string& name : chosen)
    if (layers.count(name) == 0)
      throw UserError(
          path.string() + ": prior.layers names the layer " + name +
          ", which has nothing drawn on it. Its layers are: " + name_list({layers.begin(), layers.end()}));
  if (lines.empty())
    throw UserError(path.string() + ": " +
                    (options.layers.empty() ? std::string("the drawing has no walls")
                                            : "the layers " + options.layers + " have no lines") +
                    ". Its layers are: " + name_list({layers.begin(), layers.end()}));
  return {std::move(lines), {layers.begin(), layers.end()}};
}

}  // namespace

bool is_plan_drawing(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".dxf";
}

PlanDrawing read_plan_drawing(const std::filesystem::path& path, const PlanDrawingOptions& options) {
  if (!std::ifstream(path)) throw UserError("cannot read " + path.string() + ". Check the name of the file");
  auto [lines, layers] = lines_of(path, options);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  TPoint2D low(kInfinity, kInfinity);
  TPoint2D high(-kInfinity, -kInfinity);
  for (const Line& line : lines)
    for (const TPoint2D& point : line) {
      low = {std::min(low.x, point.x), std::min(low.y, point.y)};
      high = {std::max(high.x, point.x), std::max(high.y, point.y)};
    }
  const double width_m = high.x - low.x;
  const double height_m = high.y - low.y;
  double cell_m = kLeastCell_m;
  while (width_m * height_m / (cell_m * cell_m) > kMostCells && cell_m < kMostCell_m) cell_m *= 2;
  if (!(std::max(width_m, height_m) <= kLargest_m) || !(std::max(width_m, height_m) >= 1) ||
      width_m * height_m / (cell_m * cell_m) > kMostCells)
    throw UserError(path.string() + ": the drawing measures " + fixed_text(width_m, 1) + " m x " +
                    fixed_text(height_m, 1) +
                    " m, expected 1 m to 5000 m and at most 4 square kilometres. Correct "
                    "prior.metres_per_unit, or choose layers with prior.layers");
  check_map_place(path, low, high);
  const auto cell = [&](double metres) { return std::llround(std::floor(metres / cell_m)); };
  GridLayout layout{cell_m, cell(low.x - kMargin_m), cell(low.y - kMargin_m), 0, 0};
  layout.width = cell(high.x + kMargin_m) + 1 - layout.x_min;
  layout.height = cell(high.y + kMargin_m) + 1 - layout.y_min;
  const auto grid = unknown_grid(layout);
  grid->fill(0.99F);
  for (const Line& line : lines)
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const TPoint2D along = line[i + 1] - line[i];
      const int steps = 1 + static_cast<int>(portable::hypot(along.x, along.y) / (kStepCells * cell_m));
      for (int k = 0; k <= steps; ++k) {
        const TPoint2D at = line[i] + along * (static_cast<double>(k) / steps);
        grid->setCell(static_cast<int>(cell(at.x) - layout.x_min),
                      static_cast<int>(cell(at.y) - layout.y_min), 0.01F);
      }
    }
  return {*grid, std::move(layers)};
}

}  // namespace psi_slam
