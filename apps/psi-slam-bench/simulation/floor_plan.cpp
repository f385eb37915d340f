// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/floor_plan.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

constexpr double kWallThickness_m = 0.12;

/// Interval along a wall, in metres: an opening or a solid part.
struct Opening {
  double from = 0;
  double to = 0;
};

constexpr double kHalfWall_m = kWallThickness_m / 2;

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

/// Drawing operations for a floor plan.
class PlanDrawing {
 public:
  explicit PlanDrawing(FloorPlan& plan) : plan_(plan) {}

  void line(double x0, double y0, double x1, double y1, Material material) {
    plan_.segments.push_back({{x0, y0}, {x1, y1}, material});
  }

  /// Outline of a box between two corners.
  void box(double x0, double y0, double x1, double y1, Material material) {
    line(x0, y0, x1, y0, material);
    line(x1, y0, x1, y1, material);
    line(x1, y1, x0, y1, material);
    line(x0, y1, x0, y0, material);
  }

  /// A wall along x at `y`, with openings sorted along the wall.
  void wall_along_x(double x0, double x1, double y, const std::vector<Opening>& openings = {}) {
    for (const Opening& part : solid_parts(x0, x1, openings))
      box(part.from, y - kHalfWall_m, part.to, y + kHalfWall_m, Material::kWall);
  }
  void wall_along_y(double y0, double y1, double x) {
    box(x - kHalfWall_m, y0, x + kHalfWall_m, y1, Material::kWall);
  }

  std::size_t place(double x, double y, Place::Kind kind) {
    plan_.places.push_back({{x, y}, kind});
    return plan_.places.size() - 1;
  }
  void passage(std::size_t from, std::size_t to) { plan_.passages.push_back({from, to}); }

 private:
  FloorPlan& plan_;
};

constexpr double kDoor_m = 1.1;
constexpr double kHallDoor_m = 1.8;
constexpr double kDoorToWall_m = 1.0;  // least distance from the middle of a door to the side walls
constexpr double kNarrowestRoom_m = 3.2;
constexpr double kWidestRoom_m = 7.5;
constexpr double kFurnitureClear_m = 0.6;  // least distance of furniture from the straight path into a room

/// Positions of parallel corridors, and of the blocks between them, along the axis that they cross.
struct Axis {
  std::vector<double> corridor;  ///< coordinates of the lower edges
  std::vector<double> width;

  double middle(std::size_t i) const { return corridor[i] + width[i] / 2; }
  double block_begin(std::size_t i) const { return corridor[i] + width[i]; }
  double block_end(std::size_t i) const { return corridor[i + 1]; }
  double begin() const { return corridor.front(); }
  double end() const { return corridor.back() + width.back(); }
  double length() const { return middle(corridor.size() - 1) - middle(0); }
  std::size_t blocks() const { return corridor.size() - 1; }
  void add_block(double depth, double corridor_width) {
    corridor.push_back(corridor.back() + width.back() + depth);
    width.push_back(corridor_width);
  }
};

/// A row of rooms in a block, side by side along x. All rooms have their fronts at the same corridor.
struct RoomRow {
  double x0;
  double x1;
  double y_front;
  double y_back;
  double y_corridor;  ///< centre line of the corridor in front

  double inwards() const { return y_back > y_front ? 1 : -1; }
};

class Draughtsman {
 public:
  explicit Draughtsman(const FloorPlanOptions& options)
      : options_(options), random_(options.seed, SimulationRandom::Stream::kFloorPlan), draw_(plan_) {}

  FloorPlan draw() {
    lay_out();
    for (std::size_t j = 0; j < y_.blocks(); ++j)
      for (std::size_t i = 0; i < x_.blocks(); ++i) draw_block(i, j);
    draw_outer_wall();
    link_corridors();
    return std::move(plan_);
  }

 private:
  /// A part of a corridor along x between two crossings.
  struct Stretch {
    bool bare = false;
    std::vector<std::pair<double, std::size_t>> doors;  ///< x and index of the place
  };

  Stretch& stretch(std::size_t i, std::size_t j) { return stretches_[j * x_.blocks() + i]; }
  double corridor_width() { return random_.between(1.9, 3.0); }

  double corridors_m() const {
    return x_.length() * static_cast<double>(y_.corridor.size()) +
           y_.length() * static_cast<double>(x_.corridor.size());
  }

  void lay_out() {
    for (Axis* axis : {&x_, &y_}) {
      axis->corridor.push_back(0);
      axis->width.push_back(corridor_width());
    }
    add_column();
    add_row();
    while (corridors_m() < options_.corridors_m) x_.length() < 1.4 * y_.length() ? add_column() : add_row();
    stretches_.resize(x_.blocks() * y_.corridor.size());
    for (Stretch& stretch : stretches_) stretch.bare = random_.happens(options_.bare_share);
  }
  void add_column() {
    const double length = random_.between(16, 38);
    x_.add_block(length, corridor_width());
  }
  void add_row() {
    const double depth = random_.between(11, 15);
    y_.add_block(depth, corridor_width());
  }

  void draw_block(std::size_t i, std::size_t j) {
    const double x0 = x_.block_begin(i) + kHalfWall_m;
    const double x1 = x_.block_end(i) - kHalfWall_m;
    const double y0 = y_.block_begin(j) + kHalfWall_m;
    const double y1 = y_.block_end(j) - kHalfWall_m;
    draw_.wall_along_y(y0, y1, x0);
    draw_.wall_along_y(y0, y1, x1);
    Stretch& below = stretch(i, j);
    Stretch& above = stretch(i, j + 1);
    if (!below.bare && !above.bare && random_.happens(options_.hall_share)) {
      draw_hall(x0, x1, y0, y1, j, below, above);
      return;
    }
    const double y_middle = y0 + (y1 - y0) * random_.between(0.45, 0.55);
    draw_.wall_along_x(x0, x1, y_middle);
    draw_row({x0, x1, y0, y_middle, y_.middle(j)}, below);
    draw_row({x0, x1, y1, y_middle, y_.middle(j + 1)}, above);
  }

  void draw_hall(double x0, double x1, double y0, double y1, std::size_t j, Stretch& below, Stretch& above) {
    const double x = x0 + (x1 - x0) * random_.between(0.3, 0.7);
    const Opening door{x - kHallDoor_m / 2, x + kHallDoor_m / 2};
    draw_.wall_along_x(x0, x1, y0, {door});
    draw_.wall_along_x(x0, x1, y1, {door});
    const std::size_t middle = draw_.place(x, (y0 + y1) / 2, Place::Kind::kRoom);
    add_door(below, x, y_.middle(j), middle);
    add_door(above, x, y_.middle(j + 1), middle);
    const double apart = random_.between(3.5, 5);
    const double half = random_.between(0.15, 0.3);
    for (double at_x = x0 + apart / 2; at_x < x1 - 1; at_x += apart)
      for (double at_y = y0 + apart / 2; at_y < y1 - 1; at_y += apart)
        if (std::abs(at_x - x) > half + kFurnitureClear_m)
          draw_.box(at_x - half, at_y - half, at_x + half, at_y + half, Material::kPillar);
  }

  void draw_row(const RoomRow& row, Stretch& stretch) {
    if (stretch.bare) {
      draw_.wall_along_x(row.x0, row.x1, row.y_front);
      return;
    }
    for (double x = row.x0; x < row.x1;) {
      double end = x + random_.between(kNarrowestRoom_m, kWidestRoom_m);
      if (row.x1 - end < kNarrowestRoom_m) end = row.x1;
      if (end < row.x1) draw_.wall_along_y(row.y_front, row.y_back, end);
      RoomRow room = row;
      room.x0 = x;
      room.x1 = end;
      draw_room(room, stretch);
      x = end;
    }
  }

  void draw_room(const RoomRow& room, Stretch& stretch) {
    const double in = room.inwards();
    const double door_x = random_.between(room.x0 + kDoorToWall_m, room.x1 - kDoorToWall_m);
    const Opening door{door_x - kDoor_m / 2, door_x + kDoor_m / 2};
    const double deep_y = room.y_front + (room.y_back - room.y_front) * random_.between(0.45, 0.7);
    plan_.doors.push_back({{door.from, room.y_front}, {door.to, room.y_front}, Material::kFurniture});
    draw_front(room, door);
    draw_.line(door.from, room.y_front, door.from - random_.between(0, 0.2), room.y_front + in * 0.9,
               Material::kFurniture);  // the open door leaf
    add_door(stretch, door_x, room.y_corridor, draw_.place(door_x, deep_y, Place::Kind::kRoom));
    furnish(room, door_x);
    draw_in_corridor(room, door);
  }

  void draw_front(const RoomRow& room, const Opening& door) {
    if (!random_.happens(options_.glass_share)) {
      draw_.wall_along_x(room.x0, room.x1, room.y_front, {door});
      return;
    }
    for (const double jamb : {room.x0, door.from, door.to, room.x1})
      draw_.box(jamb - kHalfWall_m, room.y_front - kHalfWall_m, jamb + kHalfWall_m,
                room.y_front + kHalfWall_m, Material::kWall);
    draw_.line(room.x0, room.y_front, door.from, room.y_front, Material::kGlass);
    draw_.line(door.to, room.y_front, room.x1, room.y_front, Material::kGlass);
  }

  /// Draws furniture: boxes outside the straight path into the room.
  void furnish(const RoomRow& room, double door_x) {
    const double y_low = std::min(room.y_front, room.y_back) + kHalfWall_m;
    const double y_high = std::max(room.y_front, room.y_back) - kHalfWall_m;
    const std::size_t pieces = 3 + random_.index(6);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const double width = random_.between(0.4, 1.6);
      const double depth = random_.between(0.35, 0.8);
      const double x = random_.between(room.x0 + kHalfWall_m, room.x1 - kHalfWall_m - width);
      const double y = random_.between(y_low, y_high - depth);
      const bool in_the_way = x < door_x + kFurnitureClear_m && x + width > door_x - kFurnitureClear_m;
      if (!in_the_way) draw_.box(x, y, x + width, y + depth, Material::kFurniture);
    }
  }

  /// Draws pilasters and cupboards in the corridor, along the front of the room.
  void draw_in_corridor(const RoomRow& room, const Opening& door) {
    const double face = room.y_front - room.inwards() * kHalfWall_m;
    if (random_.happens(0.4))
      draw_.box(room.x0 - 0.15, face, room.x0 + 0.15, face - room.inwards() * 0.12, Material::kPillar);
    const double room_left = room.x1 - door.to - 0.4;
    const double width = random_.between(0.5, 1.2);
    if (room_left > width && random_.happens(0.3)) {
      const double x = door.to + 0.2 + random_.between(0, room_left - width);
      draw_.box(x, face, x + width, face - room.inwards() * random_.between(0.2, 0.35), Material::kFurniture);
    }
  }

  void add_door(Stretch& stretch, double x, double y_corridor, std::size_t inside) {
    const std::size_t outside = draw_.place(x, y_corridor, Place::Kind::kCorridor);
    draw_.passage(outside, inside);
    stretch.doors.emplace_back(x, outside);
  }

  void draw_outer_wall() {
    for (std::size_t i = 0; i < x_.blocks(); ++i)
      for (const std::size_t j : {std::size_t{0}, y_.blocks()})
        draw_panes(true, i == 0 ? x_.begin() : x_.middle(i),
                   i + 1 == x_.blocks() ? x_.end() : x_.middle(i + 1), j == 0, stretch(i, j).bare);
    for (const bool low : {true, false}) draw_panes(false, y_.begin(), y_.end(), low, false);
  }

  /// Draws panes of wall or glass with pilasters between them, from `begin` to `end` along the x axis
  /// (`along_x`) or the y axis. A bare wall has one pane. With `low`, the wall is at the low end of the axis
  /// that it crosses.
  void draw_panes(bool along_x, double begin, double end, bool low, bool bare) {
    const Axis& across = along_x ? y_ : x_;
    const double inwards = low ? 1 : -1;
    const double wall = low ? across.begin() - kHalfWall_m : across.end() + kHalfWall_m;
    const double face = wall + inwards * kHalfWall_m;
    for (double at = begin; at < end;) {
      double next = bare ? end : at + random_.between(2.5, 6);
      if (end - next < 2) next = end;
      const bool glass = !bare && random_.happens(options_.glass_share);
      const Material material = glass ? Material::kGlass : Material::kWall;
      along_x ? draw_.line(at, face, next, face, material) : draw_.line(face, at, face, next, material);
      if (!bare && next < end && random_.happens(0.7)) {
        const double front = wall + (inwards * kHalfWall_m + inwards * random_.between(0.08, 0.25));
        along_x ? draw_.box(next - 0.12, face, next + 0.12, front, Material::kPillar)
                : draw_.box(face, next - 0.12, front, next + 0.12, Material::kPillar);
      }
      at = next;
    }
  }

  void link_corridors() {
    std::vector<std::vector<std::size_t>> crossings(x_.corridor.size());
    for (std::size_t i = 0; i < x_.corridor.size(); ++i)
      for (std::size_t j = 0; j < y_.corridor.size(); ++j)
        crossings[i].push_back(draw_.place(x_.middle(i), y_.middle(j), Place::Kind::kCrossing));
    for (std::size_t i = 0; i < x_.corridor.size(); ++i) {
      plan_.corridors.push_back(
          {{x_.middle(i), y_.middle(0)}, {x_.middle(i), y_.middle(y_.blocks())}, x_.width[i]});
      for (std::size_t j = 0; j < y_.blocks(); ++j) draw_.passage(crossings[i][j], crossings[i][j + 1]);
    }
    for (std::size_t j = 0; j < y_.corridor.size(); ++j) {
      plan_.corridors.push_back(
          {{x_.middle(0), y_.middle(j)}, {x_.middle(x_.blocks()), y_.middle(j)}, y_.width[j]});
      for (std::size_t i = 0; i < x_.blocks(); ++i)
        link_stretch(crossings[i][j], stretch(i, j), crossings[i + 1][j]);
    }
  }

  void link_stretch(std::size_t from, Stretch& stretch, std::size_t to) {
    std::sort(stretch.doors.begin(), stretch.doors.end());
    for (const auto& [x, door] : stretch.doors) {
      draw_.passage(from, door);
      from = door;
    }
    draw_.passage(from, to);
  }

  const FloorPlanOptions options_;
  SimulationRandom random_;
  FloorPlan plan_;
  PlanDrawing draw_;
  Axis x_;
  Axis y_;
  std::vector<Stretch> stretches_;  ///< stretches of the corridors along x, ordered by corridor
};

void enlarge(FloorPlan& plan, double scale) {
  for (PlanSegment& segment : plan.segments) {
    segment.from *= scale;
    segment.to *= scale;
  }
  for (Place& place : plan.places) place.at *= scale;
  for (Corridor& corridor : plan.corridors) {
    corridor.from *= scale;
    corridor.to *= scale;
    corridor.width_m *= scale;
  }
}

}  // namespace

double FloorPlan::corridors_m() const {
  double sum_m = 0;
  for (const Corridor& corridor : corridors) sum_m += distance_m(corridor.from, corridor.to);
  return sum_m;
}

std::size_t FloorPlan::rooms() const {
  return static_cast<std::size_t>(std::count_if(
      places.begin(), places.end(), [](const Place& place) { return place.kind == Place::Kind::kRoom; }));
}

FloorPlan draw_floor_plan(const FloorPlanOptions& options) {
  if (!(options.scale >= 1)) throw std::invalid_argument("draw_floor_plan: the scale is below 1");
  FloorPlanOptions unscaled = options;
  unscaled.corridors_m /= options.scale;
  FloorPlan plan = Draughtsman(unscaled).draw();
  enlarge(plan, options.scale);
  return plan;
}

}  // namespace psi_slam
