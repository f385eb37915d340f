// SPDX-License-Identifier: BSD-3-Clause
// Functions of <cmath> with the same results on every processor and with every C library.
#pragma once

#include <cmath>

namespace psi_slam::portable {

/// Sine and cosine of one angle.
struct SineCosine {
  double sin;
  double cos;
};

// The functions below return what those of <cmath> with the same names return, to at most one unit in the
// last place (atan2: 3.5 units). Angles are in radians. <cmath> itself rounds some results differently from
// one version of the C library to the next, and where the processor lacks fused multiply-add. One last bit
// may decide whether a scan becomes a node or a loop is accepted, and so change the map. These functions are
// the deterministic ones of SLEEF.

double sin(double angle_rad);
double cos(double angle_rad);
SineCosine sin_cos(double angle_rad);
double tan(double angle_rad);
double asin(double sine);
double acos(double cosine);
double atan(double tangent);
double atan2(double y, double x);
double exp(double exponent);
double log(double number);
double log1p(double number);
double log2(double number);
double log10(double number);
double pow(double base, double exponent);

/// Returns √(x² + y²) by operations that IEEE 754 defines to the last bit. The squares must be finite and not
/// denormal, as those of lengths in metres are.
inline double hypot(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// Returns √(x² + y²), computed in double and rounded once.
inline float hypot(float x, float y) {
  return static_cast<float>(hypot(static_cast<double>(x), static_cast<double>(y)));
}

}  // namespace psi_slam::portable
