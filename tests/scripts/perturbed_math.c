// SPDX-License-Identifier: BSD-3-Clause
// A library to preload: changes the last bit of about half the results of the C library's functions of <math.h>, as another
// version of the C library or another processor may.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static double perturbed(double exact) {
  uint64_t bits;
  memcpy(&bits, &exact, sizeof bits);
  if (exact == rint(exact) || !isfinite(exact)) return exact;  // every C library returns these exactly
  return (bits * 0x9e3779b97f4a7c15U) >> 63 ? nextafter(exact, INFINITY) : exact;
}

static float perturbed_float(float exact) {
  uint32_t bits;
  memcpy(&bits, &exact, sizeof bits);
  if (exact == rintf(exact) || !isfinite(exact)) return exact;
  return (bits * 0x9e3779b9U) >> 31 ? nextafterf(exact, INFINITY) : exact;
}

#define PERTURB_ONE(name)                                                \
  double name(double x) {                                                \
    static double (*exact)(double);                                      \
    if (!exact) exact = (double (*)(double))dlsym(RTLD_NEXT, #name);     \
    return perturbed(exact(x));                                          \
  }                                                                      \
  float name##f(float x) {                                               \
    static float (*exact)(float);                                        \
    if (!exact) exact = (float (*)(float))dlsym(RTLD_NEXT, #name "f");   \
    return perturbed_float(exact(x));                                    \
  }

#define PERTURB_TWO(name)                                                     \
  double name(double x, double y) {                                           \
    static double (*exact)(double, double);                                   \
    if (!exact) exact = (double (*)(double, double))dlsym(RTLD_NEXT, #name);  \
    return perturbed(exact(x, y));                                            \
  }                                                                           \
  float name##f(float x, float y) {                                           \
    static float (*exact)(float, float);                                      \
    if (!exact) exact = (float (*)(float, float))dlsym(RTLD_NEXT, #name "f"); \
    return perturbed_float(exact(x, y));                                      \
  }

PERTURB_ONE(sin)
PERTURB_ONE(cos)
PERTURB_ONE(tan)
PERTURB_ONE(asin)
PERTURB_ONE(acos)
PERTURB_ONE(atan)
PERTURB_ONE(exp)
PERTURB_ONE(exp2)
PERTURB_ONE(expm1)
PERTURB_ONE(log)
PERTURB_ONE(log2)
PERTURB_ONE(log10)
PERTURB_ONE(log1p)
PERTURB_ONE(cbrt)
PERTURB_TWO(atan2)
PERTURB_TWO(hypot)
PERTURB_TWO(pow)

void sincos(double angle_rad, double* sine, double* cosine) {
  *sine = sin(angle_rad);
  *cosine = cos(angle_rad);
}

void sincosf(float angle_rad, float* sine, float* cosine) {
  *sine = sinf(angle_rad);
  *cosine = cosf(angle_rad);
}
