// SPDX-License-Identifier: BSD-3-Clause
#include "base/portable_math.h"

#include <sleef.h>

namespace psi_slam::portable {

// "cinz" marks the functions that give the same result on every processor, without fused multiply-add.
double sin(double angle_rad) {
  return Sleef_cinz_sind1_u10purec(angle_rad);
}
double cos(double angle_rad) {
  return Sleef_cinz_cosd1_u10purec(angle_rad);
}

SineCosine sin_cos(double angle_rad) {
  const Sleef_double_2 both = Sleef_cinz_sincosd1_u10purec(angle_rad);
  return {both.x, both.y};
}

double tan(double angle_rad) {
  return Sleef_cinz_tand1_u10purec(angle_rad);
}
double asin(double sine) {
  return Sleef_cinz_asind1_u10purec(sine);
}
double acos(double cosine) {
  return Sleef_cinz_acosd1_u10purec(cosine);
}
double atan(double tangent) {
  return Sleef_cinz_atand1_u10purec(tangent);
}
double atan2(double y, double x) {
  return Sleef_cinz_atan2d1_u35purec(y, x);
}
double exp(double exponent) {
  return Sleef_cinz_expd1_u10purec(exponent);
}
double log(double number) {
  return Sleef_cinz_logd1_u10purec(number);
}
double log1p(double number) {
  return Sleef_cinz_log1pd1_u10purec(number);
}
double log2(double number) {
  return Sleef_cinz_log2d1_u10purec(number);
}
double log10(double number) {
  return Sleef_cinz_log10d1_u10purec(number);
}
double pow(double base, double exponent) {
  return Sleef_cinz_powd1_u10purec(base, exponent);
}

}  // namespace psi_slam::portable
