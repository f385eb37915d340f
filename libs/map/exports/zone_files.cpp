// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/zone_files.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "map/exports/map_server_pair.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Kind = MapEdit::Kind;
using Grid = mrpt::maps::COccupancyGridMap2D;

/// How nav2's speed filter reads a mask: limit = base + multiplier * value.
struct SpeedScale {
  int type = 1;  ///< 1: percent of the largest speed; 2: m/s
  double base = 100;
  double multiplier = -1;

  /// The value of the fastest limit that is not above `limit`.
  std::uint8_t value(double limit) const {
    constexpr double kRounding = 1e-6;
    const double exact = (limit - base) / multiplier;
    const double value = multiplier < 0 ? std::ceil(exact - kRounding) : std::floor(exact + kRounding);
    return static_cast<std::uint8_t>(std::clamp(value, 1.0, type == 1 ? 99.0 : 100.0));
  }
};

double limit_of(const MapEdit& zone) {
  return zone.percent > 0 ? zone.percent : zone.max_speed_mps;
}

/// Returns the largest speed in m/s of the slow zones; 0 without slow zones.
double fastest_of(const std::vector<MapEdit>& edits) {
  double fastest_mps = 0;
  for (const MapEdit& edit : edits)
    if (edit.kind == Kind::kSlow) fastest_mps = std::max(fastest_mps, edit.max_speed_mps);
  return fastest_mps;
}

/// For m/s, the fastest zone has the value 100, so that it is exact and all others are to 1 % of it.
SpeedScale scale_for(const std::vector<MapEdit>& edits) {
  const double fastest_mps = fastest_of(edits);
  return fastest_mps > 0 ? SpeedScale{2, 0, fastest_mps / 100} : SpeedScale{};
}

/// Text of a number that ROS 2 reads as a double, with a decimal point.
std::string double_text(double value) {
  const std::string text = trimmed_text(value, 9);
  return text.find('.') == std::string::npos ? text + ".0" : text;
}

bool has(const std::vector<MapEdit>& edits, Kind kind) {
  return std::any_of(edits.begin(), edits.end(), [&](const MapEdit& edit) { return edit.kind == kind; });
}

/// Values of a mask: `value_of` of the zones of a kind. Where zones overlap, `is_stricter` decides.
std::vector<std::uint8_t> mask_values(const Grid& grid, const std::vector<MapEdit>& edits, Kind kind,
                                      const std::function<std::uint8_t(const MapEdit&)>& value_of,
                                      const std::function<bool(std::uint8_t, std::uint8_t)>& is_stricter) {
  std::vector<std::uint8_t> values(static_cast<std::size_t>(grid.getSizeX()) * grid.getSizeY(), 0);
  for (const MapEdit& edit : edits) {
    if (edit.kind != kind) continue;
    const std::uint8_t value = value_of(edit);
    for_each_cell_of(edit, grid, [&](int x, int y) {
      std::uint8_t& cell =
          values[static_cast<std::size_t>(y) * grid.getSizeX() + static_cast<std::size_t>(x)];
      if (cell == 0 || is_stricter(value, cell)) cell = value;
    });
  }
  return values;
}

}  // namespace

void check_zones(const std::vector<MapEdit>& edits) {
  const auto any = [&](double MapEdit::*limit) {
    return std::any_of(edits.begin(), edits.end(),
                       [&](const MapEdit& edit) { return edit.kind == Kind::kSlow && edit.*limit > 0; });
  };
  if (any(&MapEdit::percent) && any(&MapEdit::max_speed_mps))
    throw UserError(
        "the edits limit the speed by percent in some slow zones and by max_speed_mps in others, expected "
        "one of them. Write all limits in the same way");
  constexpr double kRounding = 1e-9;
  const double fastest_mps = fastest_of(edits);
  const double slowest_mps = fastest_mps / 100;
  for (const MapEdit& edit : edits)
    if (edit.max_speed_mps > 0 && edit.max_speed_mps < (1 - kRounding) * slowest_mps)
      throw UserError("max_speed_mps=" + trimmed_text(edit.max_speed_mps, 9) +
                      " of a slow zone is too small beside max_speed_mps=" + trimmed_text(fastest_mps, 9) +
                      " of another one, expected at least a hundredth of it. Write max_speed_mps=" +
                      trimmed_text(slowest_mps, 9) + " or more");
}

std::string zones_text(const std::vector<MapEdit>& edits) {
  std::string text =
      "% Zones by psi-slam, one row for each corner of a polygon\n"
      "% zone, kind (0: keep out, 1: slow by percent, 2: slow by m/s), limit, x_m, y_m\n";
  int number = 0;
  for (const MapEdit& edit : edits) {
    if (!edit.is_zone()) continue;
    ++number;
    const int kind = edit.kind == Kind::kKeepOut ? 0 : edit.percent > 0 ? 1 : 2;
    for (const auto& point : edit.points)
      text += std::to_string(number) + ' ' + std::to_string(kind) + ' ' + trimmed_text(limit_of(edit), 6) +
              ' ' + trimmed_text(point.x, 6) + ' ' + trimmed_text(point.y, 6) + '\n';
  }
  return text;
}

void write_zone_files(const std::filesystem::path& folder, const Grid& grid,
                      const std::vector<MapEdit>& edits) {
  check_zones(edits);
  const auto keepout = folder / "keepout_mask.yaml";
  const auto speed = folder / "speed_mask.yaml";
  const auto zones = folder / "zones.txt";
  if (has(edits, Kind::kKeepOut))
    write_mask_pair(keepout, grid,
                    mask_values(
                        grid, edits, Kind::kKeepOut, [](const MapEdit&) { return std::uint8_t{100}; },
                        [](auto, auto) { return false; }),
                    "# costmap_filter_info_server of nav2: type 0, base 0.0, multiplier 1.0\n");
  if (has(edits, Kind::kSlow)) {
    const SpeedScale scale = scale_for(edits);
    const auto values = mask_values(
        grid, edits, Kind::kSlow, [&](const MapEdit& zone) { return scale.value(limit_of(zone)); },
        [&](std::uint8_t a, std::uint8_t b) { return scale.multiplier < 0 ? a > b : a < b; });
    write_mask_pair(speed, grid, values,
                    "# costmap_filter_info_server of nav2: type " + std::to_string(scale.type) + ", base " +
                        double_text(scale.base) + ", multiplier " + double_text(scale.multiplier) + '\n');
  }
  if (has(edits, Kind::kKeepOut) || has(edits, Kind::kSlow)) write_text_atomically(zones, zones_text(edits));
}

}  // namespace psi_slam
