// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/number_text.h"
#include "simulate/simulate_benchmark.h"

namespace psi_slam {
namespace {

constexpr double kMargin_m = 2;
constexpr double kWidth = 1200;           // of the picture, in pixels
constexpr double kBetweenPoints_m = 0.1;  // distance of the drawn points of the path

struct Layer {
  Material material;
  const char* name;
  const char* colour;
};
constexpr std::array<Layer, 4> kLayers = {{{Material::kFurniture, "furniture", "#b08850"},
                                           {Material::kPillar, "pillars", "#8a3fa0"},
                                           {Material::kGlass, "glass", "#30a8c8"},
                                           {Material::kWall, "walls", "#222222"}}};

/// Point in metres with y downwards, as SVG has it.
std::string point_text(const mrpt::math::TPoint2D& point) {
  return fixed_text(point.x, 2) + ',' + fixed_text(-point.y, 2);
}

std::string layer_svg(const FloorPlan& plan, const Layer& layer) {
  std::string path;
  for (const PlanSegment& segment : plan.segments)
    if (segment.material == layer.material)
      path += 'M' + point_text(segment.from) + 'L' + point_text(segment.to);
  return "<path id=\"" + std::string(layer.name) + "\" d=\"" + path + "\" stroke=\"" + layer.colour +
         "\" stroke-width=\"0.12\"/>\n";
}

std::string path_svg(const Trajectory& truth) {
  std::string points;
  mrpt::math::TPoint2D last(std::numeric_limits<double>::infinity(), 0);
  for (const StampedPose& stamped : truth) {
    const mrpt::math::TPoint2D here(stamped.pose.x, stamped.pose.y);
    if (std::hypot(here.x - last.x, here.y - last.y) < kBetweenPoints_m) continue;
    last = here;
    points += (points.empty() ? "" : " ") + point_text(here);
  }
  return "<polyline id=\"path\" points=\"" + points +
         "\" stroke=\"#c2571a\" stroke-width=\"0.1\" stroke-opacity=\"0.5\" stroke-linejoin=\"round\"/>\n";
}

}  // namespace

std::string plan_svg(const FloorPlan& plan, const Trajectory& truth) {
  double x_min = 0;
  double x_max = 0;
  double y_min = 0;
  double y_max = 0;
  for (const PlanSegment& segment : plan.segments)
    for (const mrpt::math::TPoint2D& end : {segment.from, segment.to}) {
      x_min = std::min(x_min, end.x - kMargin_m);
      x_max = std::max(x_max, end.x + kMargin_m);
      y_min = std::min(y_min, end.y - kMargin_m);
      y_max = std::max(y_max, end.y + kMargin_m);
    }
  const double height = kWidth * (y_max - y_min) / (x_max - x_min);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + fixed_text(kWidth, 0) +
                    "\" height=\"" + fixed_text(height, 0) + "\" viewBox=\"" + fixed_text(x_min, 2) + ' ' +
                    fixed_text(-y_max, 2) + ' ' + fixed_text(x_max - x_min, 2) + ' ' +
                    fixed_text(y_max - y_min, 2) + "\" fill=\"none\" stroke-linecap=\"round\">\n" +
                    "<rect x=\"" + fixed_text(x_min, 2) + "\" y=\"" + fixed_text(-y_max, 2) +
                    "\" width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + path_svg(truth);
  for (const Layer& layer : kLayers) svg += layer_svg(plan, layer);
  return svg + "</svg>\n";
}

}  // namespace psi_slam
