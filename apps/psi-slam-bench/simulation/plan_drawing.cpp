// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/plan_drawing.h"

namespace psi_slam {
namespace {

constexpr double kHalf = kWallThickness_m / 2;

/// The parts of [from, to] outside the openings, which must be sorted.
std::vector<Opening> solid_parts(double from, double to, const std::vector<Opening>& openings) {
  std::vector<Opening> parts;
  for (const Opening& opening : openings) {
    parts.push_back({from, opening.from});
    from = opening.to;
  }
  parts.push_back({from, to});
  return parts;
}

}  // namespace

void PlanDrawing::line(double x0, double y0, double x1, double y1, Material material) {
  plan_.segments.push_back({{x0, y0}, {x1, y1}, material});
}

void PlanDrawing::box(double x0, double y0, double x1, double y1, Material material) {
  line(x0, y0, x1, y0, material);
  line(x1, y0, x1, y1, material);
  line(x1, y1, x0, y1, material);
  line(x0, y1, x0, y0, material);
}

void PlanDrawing::wall_along_x(double x0, double x1, double y, const std::vector<Opening>& openings) {
  for (const Opening& part : solid_parts(x0, x1, openings))
    box(part.from, y - kHalf, part.to, y + kHalf, Material::kWall);
}

void PlanDrawing::wall_along_y(double y0, double y1, double x, const std::vector<Opening>& openings) {
  for (const Opening& part : solid_parts(y0, y1, openings))
    box(x - kHalf, part.from, x + kHalf, part.to, Material::kWall);
}

std::size_t PlanDrawing::place(double x, double y, Place::Kind kind) {
  plan_.places.push_back({{x, y}, kind});
  return plan_.places.size() - 1;
}

}  // namespace psi_slam
