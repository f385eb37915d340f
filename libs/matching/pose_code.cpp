// SPDX-License-Identifier: BSD-3-Clause
#include "matching/pose_code.h"

#include <stdexcept>
#include <string>

namespace psi_slam {
namespace {

// Returns the smallest l with 2^l > count.
int bits_beyond(std::uint64_t count) {
  int bits = 0;
  while (bits < 64 && (count >> bits) != 0) ++bits;
  return bits;
}

constexpr std::uint64_t low_bits(int bits) {
  return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
}

}  // namespace

PoseCode::PoseCode(const SearchWindow& window)
    : n_x_(window.n_x),
      n_y_(window.n_y),
      n_theta_(window.n_theta),
      positions_(std::uint64_t{2} * window.n_x * (std::uint64_t{2} * window.n_y)),
      angles_(std::uint64_t{2} * window.n_theta),
      position_bits_(bits_beyond(positions_)),
      angle_bits_(bits_beyond(angles_)) {
  if (n_x_ < 1 || n_y_ < 1 || n_theta_ < 1 || bits() > 64)
    throw std::invalid_argument("no chromosome for a window of " + std::to_string(n_x_) + " x " +
                                std::to_string(n_y_) + " x " + std::to_string(n_theta_) + " steps");
}

std::uint64_t PoseCode::position(Chromosome chromosome) const {
  return chromosome & low_bits(position_bits_);
}

std::uint64_t PoseCode::angle(Chromosome chromosome) const {
  return (chromosome >> position_bits_) & low_bits(angle_bits_);
}

Chromosome PoseCode::encode(const LatticePose& pose) const {
  const auto column = static_cast<std::uint64_t>(pose.x + n_x_);
  const auto row = static_cast<std::uint64_t>(pose.y + n_y_);
  const auto turn = static_cast<std::uint64_t>(pose.theta + n_theta_);
  return (row * 2 * n_x_ + column) | (turn << position_bits_);
}

LatticePose PoseCode::decode(Chromosome chromosome) const {
  const std::uint64_t cell = position(chromosome) % positions_;
  const std::uint64_t columns = std::uint64_t{2} * n_x_;
  return {static_cast<int>(cell % columns) - n_x_, static_cast<int>(cell / columns) - n_y_,
          static_cast<int>(angle(chromosome) % angles_) - n_theta_};
}

}  // namespace psi_slam
