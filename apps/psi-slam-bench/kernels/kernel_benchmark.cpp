// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/kernel_benchmark.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

#include "base/portable_math.h"
#include "common/processor_time.h"
#include "kernels/reading_speed.h"
#include "matching/point_kernels.h"
#include "matching/refinement_kernel.h"
#include "matching/score_grid.h"
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

constexpr std::size_t kPoints = 160;
constexpr int kSide = 500;  // of the score grid, in cells
constexpr double kResolution_m = 0.05;
constexpr float kRadius_m = 10;
constexpr float kRadius_cells = 200;
constexpr std::size_t kNear = 36;               // points among which the nearest are sought, a usual number
constexpr std::size_t kGridBytes = 1000 * 256;  // rounded up
constexpr std::size_t kFewBytes = 16 * 256;     // of points and results
constexpr std::size_t kCalls = 2000;            // that are measured together

using NearestKeys = std::array<std::int64_t, NeighbourKeys::kBlock>;

/// A scan from the middle of a round room, and the score grid of its wall.
struct RoundRoom {
  RoundRoom() : grid(0, 0, kResolution_m, kSide, kSide), cells(kPoints), offsets(kPoints), squares(kPoints) {
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / kPoints;
      const auto x = static_cast<float>(portable::cos(angle));
      const auto y = static_cast<float>(portable::sin(angle));
      points.insert(points.end(), {kRadius_m * x, kRadius_m * y});
      normals.insert(normals.end(), {-x, -y});
      x_cells.push_back(kRadius_cells * x);
      y_cells.push_back(kRadius_cells * y);
    }
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double from_wall = portable::hypot(x - kSide / 2.0, y - kSide / 2.0) - double{kRadius_cells};
        *grid.finest().cell(x, y) =
            static_cast<std::uint8_t>(255 * portable::exp(-0.5 * from_wall * from_wall));
      }
    placement.x0 = placement.y0 = kSide / 2.0;
    placement.cosine = 1 / kResolution_m;
    point_kernels().place(placement, points.data(), kPoints, cells.data());
    point_kernels().find_offsets(unclipped(), cells.data(), kPoints, offsets.data());
  }

  UnclippedCells unclipped() const {
    UnclippedCells all;
    all.shift = all.first = {0, 0};
    all.last = {kSide, kSide};
    all.row_bytes = static_cast<std::int32_t>(grid.finest().row_bytes());
    return all;
  }

  ScoreGrid grid;
  CellPlacement<double> placement;
  std::vector<float> points;  // x and y in turn
  std::vector<float> normals;
  std::vector<float> x_cells;
  std::vector<float> y_cells;
  std::vector<Cell> cells;
  std::vector<std::int32_t> offsets;
  std::vector<std::int32_t> squares;
};

double call_ns(std::size_t repeats, const std::function<void()>& call) {
  return 1e6 / kCalls * least_ms(repeats, [&] {
           for (std::size_t i = 0; i < kCalls; ++i) call();
         });
}

/// Returns the kernel for a set; null if this machine lacks the set, or if a smaller set has the same kernel.
template <class Kernel>
Kernel own_kernel(Kernel (*kernel_for)(InstructionSet), InstructionSet set) {
  const Kernel kernel = kernel_for(set);
  for (const InstructionSet smaller : kInstructionSets) {
    if (smaller == set) break;
    if (kernel_for(smaller) == kernel) return nullptr;
  }
  return kernel;
}

/// A kernel and what to call for an instruction set. An empty function: there is no own_kernel().
struct TimedKernel {
  const char* name;
  std::size_t bytes;
  std::size_t memory_bytes;  ///< size of the memory that the kernel works in
  std::function<std::function<void()>(InstructionSet)> call_for;
};

std::function<void()> sum_call(const RoundRoom& room, SumKernel kernel, int height) {
  return [&room, kernel, height,
          found = std::vector<std::uint32_t>(kSumLanes * static_cast<std::size_t>(height), 0)]() mutable {
    const ScoreLevel& cells = room.grid.finest();
    kernel(cells.cell(0, 0), cells.row_bytes(), room.offsets.data(), kPoints, kSumLanes, height, found.data(),
           kSumLanes);
  };
}

TimedKernel timed_sum(const RoundRoom& room, const char* name, int height) {
  const std::size_t sums = kSumLanes * static_cast<std::size_t>(height);
  return {name, kPoints * (sums + sizeof(std::int32_t)) + 2 * sums * sizeof(std::uint32_t), kGridBytes,
          [&room, height](InstructionSet set) -> std::function<void()> {
            const SumKernel kernel = own_kernel(&sum_kernel_for, set);
            if (kernel == nullptr) return {};
            return sum_call(room, kernel, height);
          }};
}

TimedKernel timed_refinement(const RoundRoom& room) {
  constexpr std::size_t kCells = 16;  // of a cubic interpolation
  return {"compare points with the grid", kPoints * (kCells + 4 * sizeof(float)), kGridBytes,
          [&room](InstructionSet set) -> std::function<void()> {
            const RefinementKernel kernel = own_kernel(&refinement_kernel_for, set);
            if (kernel == nullptr) return {};
            PlacedScan scan;
            scan.cells = room.grid.finest().cell(0, 0);
            scan.row_bytes = room.grid.finest().row_bytes();
            scan.width = scan.height = kSide;
            scan.cells_per_m = 1 / kResolution_m;
            scan.x_cells = scan.y_cells = kSide / 2.0;
            scan.points = room.points.data();
            scan.normals = room.normals.data();
            scan.count = kPoints;
            return [scan, kernel] { kernel(scan); };
          }};
}

/// One of the point kernels: `call(kernels)` calls one of them.
template <class Call>
TimedKernel timed_point_kernel(const char* name, std::size_t bytes, const Call& call) {
  return {name, bytes, kFewBytes, [call](InstructionSet set) -> std::function<void()> {
            const PointKernels* kernels = own_kernel(&point_kernels_for, set);
            if (kernels == nullptr) return {};
            return [call, kernels] { call(*kernels); };
          }};
}

std::vector<TimedKernel> timed_kernels(RoundRoom& room, NearestKeys& keys,
                                       const std::vector<std::uint32_t>& indices) {
  SquareSearch search;
  search.middle.x0 = search.middle.y0 = kSide / 2.0F;
  search.across = 0.01F;
  search.stride = 4;
  search.window_columns = search.window_rows = 8;
  search.layout.phases = 2;
  search.layout.log_phases = 1;
  search.layout.plane_columns = search.layout.plane_rows = kSide;
  return {timed_sum(room, "sum scores of 16 x 8 poses", 8),
          timed_sum(room, "sum scores of 16 x 4 poses", 4),
          timed_refinement(room),
          timed_point_kernel("place points", kPoints * (2 * sizeof(float) + sizeof(Cell)),
                             [&](const PointKernels& kernels) {
                               kernels.place(room.placement, room.points.data(), kPoints, room.cells.data());
                             }),
          timed_point_kernel("find offsets of cells", kPoints * (sizeof(Cell) + sizeof(std::int32_t)),
                             [&](const PointKernels& kernels) {
                               kernels.find_offsets(room.unclipped(), room.cells.data(), kPoints,
                                                    room.offsets.data());
                             }),
          timed_point_kernel("find squares of points", kPoints * (2 * sizeof(float) + sizeof(std::int32_t)),
                             [&room, search](const PointKernels& kernels) {
                               kernels.find_squares(search, room.x_cells.data(), room.y_cells.data(), kPoints,
                                                    room.squares.data());
                             }),
          timed_point_kernel("find the 8 nearest of 36 points",
                             kNear * (2 * sizeof(float) + sizeof(std::uint32_t)) + 2 * sizeof(NearestKeys),
                             [&](const PointKernels& kernels) {
                               keys.fill(INT64_MAX);
                               kernels.merge_nearest(
                                   room.x_cells[kNear / 2], room.y_cells[kNear / 2],
                                   {room.x_cells.data(), room.y_cells.data(), indices.data(), kNear},
                                   {keys.data(), 1});
                             })};
}

}  // namespace

double sum_kernel_scores_per_ns(std::size_t repeats) {
  constexpr int kHeight = 8;
  const RoundRoom room;
  return static_cast<double>(kPoints * kSumLanes * kHeight) /
         call_ns(repeats, sum_call(room, sum_kernel(), kHeight));
}

KernelBenchmark run_kernel_benchmark(const KernelBenchmarkOptions& options) {
  RoundRoom room;
  NearestKeys keys{};
  std::vector<std::uint32_t> indices(kNear);
  std::iota(indices.begin(), indices.end(), 0);
  KernelBenchmark benchmark;
  for (const TimedKernel& kernel : timed_kernels(room, keys, indices)) {
    const double limit = reading_bytes_per_ns(kernel.memory_bytes, options.repeats);
    for (const InstructionSet set : kInstructionSets)
      if (const auto call = kernel.call_for(set))
        benchmark.rows.push_back(
            {kernel.name, set, static_cast<double>(kernel.bytes), call_ns(options.repeats, call), limit});
  }
  return benchmark;
}

}  // namespace psi_slam
