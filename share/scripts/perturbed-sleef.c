// SPDX-License-Identifier: BSD-3-Clause
// A library to preload: changes the last bit of about half the results of the functions of SLEEF that psi-slam calls. The
// environment variable ROUNDING_SEED selects the results.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <math.h>
#include <sleef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static uint64_t seed;

__attribute__((constructor)) static void read_seed(void) {
  const char* text = getenv("ROUNDING_SEED");
  seed = text ? strtoull(text, NULL, 10) : 0;
}

static double perturbed(double exact) {
  if (seed == 0 || exact == rint(exact) || !isfinite(exact)) return exact;
  uint64_t bits;
  memcpy(&bits, &exact, sizeof bits);
  bits = (bits ^ seed * 0x9e3779b97f4a7c15U) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ bits >> 29) * 0x94d049bb133111ebU;
  return bits >> 63 ? nextafter(exact, INFINITY) : exact;
}

#define PERTURB_ONE(name)                                            \
  double name(double x) {                                            \
    static double (*exact)(double);                                  \
    if (!exact) exact = (double (*)(double))dlsym(RTLD_NEXT, #name); \
    return perturbed(exact(x));                                      \
  }

#define PERTURB_TWO(name)                                                            \
  double name(double x, double y) {                                                  \
    static double (*exact)(double, double);                                          \
    if (!exact) exact = (double (*)(double, double))dlsym(RTLD_NEXT, #name);         \
    return perturbed(exact(x, y));                                                   \
  }

PERTURB_ONE(Sleef_cinz_sind1_u10purec)
PERTURB_ONE(Sleef_cinz_cosd1_u10purec)
PERTURB_ONE(Sleef_cinz_tand1_u10purec)
PERTURB_ONE(Sleef_cinz_asind1_u10purec)
PERTURB_ONE(Sleef_cinz_acosd1_u10purec)
PERTURB_ONE(Sleef_cinz_atand1_u10purec)
PERTURB_TWO(Sleef_cinz_atan2d1_u35purec)
PERTURB_ONE(Sleef_cinz_expd1_u10purec)
PERTURB_ONE(Sleef_cinz_logd1_u10purec)
PERTURB_ONE(Sleef_cinz_log1pd1_u10purec)
PERTURB_ONE(Sleef_cinz_log2d1_u10purec)
PERTURB_ONE(Sleef_cinz_log10d1_u10purec)
PERTURB_TWO(Sleef_cinz_powd1_u10purec)

Sleef_double_2 Sleef_cinz_sincosd1_u10purec(double angle_rad) {
  static Sleef_double_2 (*exact)(double);
  if (!exact) exact = (Sleef_double_2(*)(double))dlsym(RTLD_NEXT, "Sleef_cinz_sincosd1_u10purec");
  Sleef_double_2 both = exact(angle_rad);
  both.x = perturbed(both.x);
  both.y = perturbed(both.y);
  return both;
}
