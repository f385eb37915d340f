// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/robust_kernel.h"

#include <cmath>

namespace psi_slam {

double RobustKernel::cost(double chi2) const {
  const double width2 = width * width;
  switch (type) {
    case Type::kNone:
      return chi2;
    case Type::kHuber:
      return chi2 <= width2 ? chi2 : 2 * width * std::sqrt(chi2) - width2;
    case Type::kCauchy:
      return width2 * std::log1p(chi2 / width2);
    case Type::kDynamicScaling:
      return chi2 <= width2 ? chi2 : width2 * (3 * chi2 - width2) / (chi2 + width2);
    case Type::kGemanMcClure:
      return width2 * chi2 / (width2 + chi2);
  }
  return chi2;
}

double RobustKernel::weight(double chi2) const {
  const double width2 = width * width;
  switch (type) {
    case Type::kNone:
      return 1;
    case Type::kHuber:
      return chi2 <= width2 ? 1 : width / std::sqrt(chi2);
    case Type::kCauchy:
      return 1 / (1 + chi2 / width2);
    case Type::kDynamicScaling: {
      const double scale = chi2 <= width2 ? 1 : 2 * width2 / (width2 + chi2);
      return scale * scale;
    }
    case Type::kGemanMcClure: {
      const double scale = width2 / (width2 + chi2);
      return scale * scale;
    }
  }
  return 1;
}

}  // namespace psi_slam
