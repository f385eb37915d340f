// SPDX-License-Identifier: BSD-3-Clause
// The body of the refinement kernel, with GCC's vector types: eight points at a time. It is compiled for
// the baseline and for AVX-512. All functions have internal linkage and call no templates of the standard
// library, because the linker must not merge code for different instruction sets.
#pragma once

#include <cstring>

#include "matching/refinement_kernel.h"

namespace psi_slam {
namespace {

constexpr int kLanes = 8;
// Column and row to which points outside the grid are moved: all cells that are read there are 0.
constexpr int kInMargin = -8;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));
using Doubles = double __attribute__((vector_size(8 * kLanes)));
using Longs = std::int64_t __attribute__((vector_size(8 * kLanes)));

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the first of four cells is the lowest byte");

inline Doubles widened(const Floats& values) {
  return __builtin_convertvector(values, Doubles);
}

struct Vectors {
  Doubles x;
  Doubles y;
};

// Returns the x and y of eight points, which are stored in turn.
inline Vectors split(const float* pairs) {
  Floats low, high;
  std::memcpy(&low, pairs, sizeof low);
  std::memcpy(&high, pairs + kLanes, sizeof high);
  return {widened(__builtin_shufflevector(low, high, 0, 2, 4, 6, 8, 10, 12, 14)),
          widened(__builtin_shufflevector(low, high, 1, 3, 5, 7, 9, 11, 13, 15))};
}

inline Vectors turned(const Vectors& v, double cosine, double sine) {
  return {cosine * v.x - sine * v.y, sine * v.x + cosine * v.y};
}

// Catmull-Rom weights of four neighbouring values and their derivatives, at the position u from 0 to 1
// between the middle two values.
struct CubicWeights {
  Floats value[4];
  Floats slope[4];

  explicit CubicWeights(const Floats& u) {
    constexpr float kCubic[4] = {-0.5F, 1.5F, -1.5F, 0.5F};
    constexpr float kSquare[4] = {1.0F, -2.5F, 2.0F, -0.5F};
    constexpr float kLinear[4] = {-0.5F, 0.0F, 0.5F, 0.0F};
    constexpr float kConstant[4] = {0.0F, 1.0F, 0.0F, 0.0F};
    for (int i = 0; i < 4; ++i) {
      value[i] = ((kCubic[i] * u + kSquare[i]) * u + kLinear[i]) * u + kConstant[i];
      slope[i] = (3.0F * kCubic[i] * u + 2.0F * kSquare[i]) * u + kLinear[i];
    }
  }
};

inline Floats dot(const Floats (&values)[4], const Floats (&weights)[4]) {
  return (values[0] * weights[0] + values[1] * weights[1]) +
         (values[2] * weights[2] + values[3] * weights[3]);
}

// Returns the largest integers not above the values, which are at least kInMargin. A value within rounding
// below an integer counts as that integer.
inline Ints floors(const Doubles& values) {
  return __builtin_convertvector(values - static_cast<double>(kInMargin), Ints) + kInMargin;
}

// Interpolated scores and their derivatives, in units of a score byte and of a cell.
struct Samples {
  Floats value;
  Floats d_dx;
  Floats d_dy;
};

inline Samples interpolate(const PlacedScan& scan, const Doubles& x, const Doubles& y) {
  const Ints column = floors(x);
  const Ints row = floors(y);
  const CubicWeights wx(__builtin_convertvector(x - __builtin_convertvector(column, Doubles), Floats));
  const CubicWeights wy(__builtin_convertvector(y - __builtin_convertvector(row, Doubles), Floats));
  Floats across[4] = {};  // weighted sums over the rows, one per column
  Floats across_slope[4] = {};
  for (int j = 0; j < 4; ++j) {
    Ints cells = {};  // four neighbouring cells of a row, for each point
    for (int lane = 0; lane < kLanes; ++lane) {
      std::int32_t four = 0;
      const std::ptrdiff_t offset = (row[lane] - 1 + j) * scan.row_bytes + column[lane] - 1;
      std::memcpy(&four, scan.cells + offset, sizeof four);
      cells[lane] = four;
    }
    for (int i = 0; i < 4; ++i) {
      const Floats scores = __builtin_convertvector((cells >> (8 * i)) & 255, Floats);
      across[i] += wy.value[j] * scores;
      across_slope[i] += wy.slope[j] * scores;
    }
  }
  return {dot(across, wx.value), dot(across, wx.slope), dot(across_slope, wx.value)};
}

struct LaneSums {
  Doubles squares{}, scores{}, xx{}, xy{}, yy{}, x_phi{}, y_phi{}, phi_phi{}, x{}, y{}, phi{};
};

// Adds eight points. A lane with used = 0 adds nothing, with used = 1 its point.
inline void add(const PlacedScan& scan, const float* points, const float* normals, const Doubles& used,
                LaneSums& sums) {
  const Vectors arm = turned(split(points), scan.cosine, scan.sine);
  const Doubles x = scan.x_cells + arm.x * scan.cells_per_m;
  const Doubles y = scan.y_cells + arm.y * scan.cells_per_m;
  const Longs inside =
      (x >= -2.0) & (x < scan.width + 1.0) & (y >= -2.0) & (y < scan.height + 1.0) & (used > 0.0);
  const Doubles margin = static_cast<double>(kInMargin) - Doubles{};
  const Samples samples = interpolate(scan, inside ? x : margin, inside ? y : margin);

  const Doubles score = widened(samples.value) / 255.0;
  const double per_metre = scan.cells_per_m / 255.0;
  Doubles d_dx = widened(samples.d_dx) * per_metre;
  Doubles d_dy = widened(samples.d_dy) * per_metre;
  if (normals != nullptr) {
    const Vectors robot_normal = split(normals);
    const Longs without = (robot_normal.x == 0.0) & (robot_normal.y == 0.0);
    const Vectors normal = turned(robot_normal, scan.cosine, scan.sine);
    const Doubles slope = d_dx * normal.x + d_dy * normal.y;
    d_dx = without ? d_dx : slope * normal.x;
    d_dy = without ? d_dy : slope * normal.y;
  }
  const Doubles d_dphi = arm.x * d_dy - arm.y * d_dx;
  const Doubles residual = used - score;
  sums.squares += residual * residual;
  sums.scores += score;
  sums.xx += d_dx * d_dx;
  sums.xy += d_dx * d_dy;
  sums.yy += d_dy * d_dy;
  sums.x_phi += d_dx * d_dphi;
  sums.y_phi += d_dy * d_dphi;
  sums.phi_phi += d_dphi * d_dphi;
  sums.x += d_dx * residual;
  sums.y += d_dy * residual;
  sums.phi += d_dphi * residual;
}

inline double total(const Doubles& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

ScoreSums sum_scores(const PlacedScan& scan) {
  LaneSums sums;
  const Doubles all = 1.0 - Doubles{};
  const std::size_t whole = scan.count - scan.count % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes)
    add(scan, scan.points + 2 * i, scan.normals == nullptr ? nullptr : scan.normals + 2 * i, all, sums);
  if (const std::size_t rest = scan.count - whole; rest > 0) {
    float points[2 * kLanes] = {};
    float normals[2 * kLanes] = {};
    std::memcpy(points, scan.points + 2 * whole, 2 * rest * sizeof *points);
    if (scan.normals != nullptr) std::memcpy(normals, scan.normals + 2 * whole, 2 * rest * sizeof *normals);
    Doubles used = {};
    for (std::size_t lane = 0; lane < rest; ++lane) used[lane] = 1;
    add(scan, points, scan.normals == nullptr ? nullptr : normals, used, sums);
  }
  return {total(sums.squares), total(sums.scores), total(sums.xx),    total(sums.xy),
          total(sums.yy),      total(sums.x_phi),  total(sums.y_phi), total(sums.phi_phi),
          total(sums.x),       total(sums.y),      total(sums.phi)};
}

}  // namespace
}  // namespace psi_slam
