// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulated_log_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/compression/compression.h"
#include "base/number_text.h"
#include "common/bench_command.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/corrected_log.h"
#include "psi_slam/user_error.h"
#include "simulate/simulate_benchmark.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".clf.gz";

/// Path of the file beside `log` that has the ending `ending` instead of kEnding.
fs::path beside(const fs::path& log, const std::string& ending) {
  const std::string name = log.filename().string();
  return log.parent_path() / (name.substr(0, name.size() - std::string(kEnding).size()) + ending);
}

std::string relations_text(const std::vector<Relation>& relations) {
  std::string text;
  for (const Relation& relation : relations) {
    const mrpt::math::TPose2D& pose = relation.pose1_T_pose2;
    text += format_seconds(relation.time1_us) + ' ' + format_seconds(relation.time2_us) + ' ' +
            fixed_text(pose.x, 6) + ' ' + fixed_text(pose.y, 6) + " 0 0 0 " + fixed_text(pose.phi, 6) + '\n';
  }
  return text;
}

constexpr double kMargin_m = 2;
constexpr double kWidth = 1200;           // width of the picture in pixels
constexpr double kBetweenPoints_m = 0.1;  // least distance between drawn points of the path

struct Layer {
  Material material;
  const char* name;
  const char* colour;
};
constexpr std::array<Layer, 4> kLayers = {{{Material::kFurniture, "furniture", "#b08850"},
                                           {Material::kPillar, "pillars", "#8a3fa0"},
                                           {Material::kGlass, "glass", "#30a8c8"},
                                           {Material::kWall, "walls", "#222222"}}};

/// Point in metres with the y axis downwards, as in SVG.
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
    if (distance_m(last, here) < kBetweenPoints_m) continue;
    last = here;
    points += (points.empty() ? "" : " ") + point_text(here);
  }
  return "<polyline id=\"path\" points=\"" + points +
         "\" stroke=\"#c2571a\" stroke-width=\"0.1\" stroke-opacity=\"0.5\" stroke-linejoin=\"round\"/>\n";
}

}  // namespace

void check_simulated_log_file(const fs::path& log) {
  const std::string name = log.filename().string();
  const std::string ending = kEnding;
  if (name.size() <= ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
    throw UserError(log.string() + " cannot be a log file: choose a name that ends in " + ending);
  check_writable(log);
}

void write_simulated_log(const fs::path& log, const SimulatedLogOptions& run) {
  SimulatedLog simulated(run);
  std::vector<Frame> frames;
  std::vector<mrpt::math::TPose2D> poses;
  Trajectory truth;
  while (std::optional<Frame> frame = simulated.next()) {
    poses.push_back(simulated.world_T_robot());
    truth.push_back({frame->time_us, simulated.world_T_robot()});
    frames.push_back(*std::move(frame));
  }
  const ScratchFile plain(log.string() + ".plain");
  write_corrected_log(plain.path, frames, poses);
  std::ifstream file(plain.path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  write_text_atomically(log, gzipped(text.data(), text.size()));
  write_text_atomically(beside(log, ".relations"),
                        relations_text(draw_relations(truth, kRelations, run.path.seed)));
  write_tum(beside(log, ".tum"), truth);
}

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
