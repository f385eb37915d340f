// SPDX-License-Identifier: BSD-3-Clause
// Robust kernels: the cost rho(s) that a constraint adds instead of its squared error s = e^T Omega e, so
// that a false one cannot bend the whole map. All are scaled so that rho(s) ~ s for small s.
#pragma once

namespace psi_slam {

struct RobustKernel {
  enum class Type {
    kNone,            ///< s
    kHuber,           ///< grows linearly beyond the width; convex
    kCauchy,          ///< grows logarithmically
    kDynamicScaling,  ///< dynamic covariance scaling (Agarwal et al., ICRA 2013): bounded by 3 width^2
    kGemanMcClure,    ///< bounded by width^2; the kernel of graduated non-convexity (Yang et al., RA-L 2020)
  };

  Type type = Type::kNone;
  double width = 1;  ///< > 0, in standard deviations: of sqrt(e^T Omega e)

  /// rho(chi2), chi2 >= 0.
  double cost(double chi2) const;

  /// drho/dchi2 in [0, 1]: the factor on the information matrix of iteratively reweighted least squares.
  double weight(double chi2) const;
};

}  // namespace psi_slam
