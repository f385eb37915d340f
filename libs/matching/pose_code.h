// SPDX-License-Identifier: BSD-3-Clause
// The chromosome of equations 9, 10 and 12 encodes a pose of the search window as two binary integers: the
// linear index of its cell and the index of its angle.
//
//     L = (y + n_y) 2 n_x + (x + n_x),   0 <= L < L_max = 2 n_x 2 n_y
//     R = theta + n_theta,               0 <= R < R_max = 2 n_theta
//     smallest l_1, l_2 with 2^l_1 > L_max, 2^l_2 > R_max
//
// with x, y, theta in steps from the window's centre. Cells are half open: the exhaustive search includes the
// last column, row and angle +n, but they have no code. A genetic search therefore never finds a pose there.
// If +n had a code, it would equal the code of the first column of the next row. Codes outside the window are
// repaired by the modulus.
#pragma once

#include <cstdint>

#include "matching/search_lattice.h"
#include "matching/search_window.h"

namespace psi_slam {

/// Code of a pose as a bit string. From the least significant bit: l_1 bits of the position, then l_2 bits of
/// the angle.
using Chromosome = std::uint64_t;

class PoseCode {
 public:
  /// Computes l_1 and l_2 for a window. Throws std::invalid_argument if the window needs more than 64 bits or
  /// has no steps along an axis.
  explicit PoseCode(const SearchWindow& window);

  int position_bits() const { return position_bits_; }  ///< number of bits of the position, l_1
  int angle_bits() const { return angle_bits_; }        ///< number of bits of the angle, l_2
  int bits() const { return position_bits_ + angle_bits_; }

  /// Encodes a pose with -n <= steps < n on each axis.
  Chromosome encode(const LatticePose& pose) const;

  /// Decodes any bits() bits: codes outside the window are replaced by their remainder.
  LatticePose decode(Chromosome chromosome) const;

 private:
  std::uint64_t position(Chromosome chromosome) const;
  std::uint64_t angle(Chromosome chromosome) const;

  int n_x_;
  int n_y_;
  int n_theta_;
  std::uint64_t positions_;  // number of positions, L_max
  std::uint64_t angles_;     // number of angles, R_max
  int position_bits_;
  int angle_bits_;
};

}  // namespace psi_slam
