// SPDX-License-Identifier: BSD-3-Clause
// Puts parts of the robot's own body into scans: a mast, and a cable that some scans miss.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

struct RobotBody {
  static constexpr std::size_t kMastBeams = 8;
  static constexpr double kMast_m = 0.35;
  static constexpr std::size_t kCableBeams = 2;
  static constexpr double kCable_m = 0.6;
  static constexpr double kNoise_m = 0.01;  ///< standard deviation

  static std::size_t first_mast_beam(std::size_t beams) { return beams / 4; }
  static std::size_t first_cable_beam(std::size_t beams) { return 3 * beams / 4; }

  /// Replaces ranges by those of the mast, and in half of the scans by those of the cable. The number of the
  /// scan seeds the noise.
  static void put_into(std::vector<float>& ranges_m, std::size_t scan) {
    std::mt19937 random(static_cast<unsigned>(scan));
    std::normal_distribution<double> noise(0, kNoise_m);
    const std::size_t beams = ranges_m.size();
    for (std::size_t i = 0; i < kMastBeams; ++i)
      ranges_m[first_mast_beam(beams) + i] = static_cast<float>(kMast_m + noise(random));
    for (std::size_t i = 0; i < kCableBeams; ++i)
      if (random() % 2 == 0)
        ranges_m[first_cable_beam(beams) + i] = static_cast<float>(kCable_m + noise(random));
  }
};

/// Frames of another source, in which the first laser sees the robot's body.
class SeesRobotBody : public FrameSource {
 public:
  explicit SeesRobotBody(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (frame) RobotBody::put_into(frame->scan.ranges_m, frame->index);
    return frame;
  }
  double progress() const override { return source_->progress(); }

 private:
  std::unique_ptr<FrameSource> source_;
};

}  // namespace psi_slam
