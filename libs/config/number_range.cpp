// SPDX-License-Identifier: BSD-3-Clause
#include "config/number_range.h"

#include <cmath>

#include "config/exact_number.h"

namespace psi_slam {

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (min && !(min->inclusive ? value >= min->value : value > min->value)) return false;
  if (max && !(max->inclusive ? value <= max->value : value < max->value)) return false;
  return true;
}

std::string NumberRange::words() const {
  if (!min && !max) return "";
  if (!max) return min->inclusive ? exact_text(min->value) + " or more" : "above " + exact_text(min->value);
  if (!min) return max->inclusive ? exact_text(max->value) + " or less" : "below " + exact_text(max->value);
  if (min->inclusive && max->inclusive)
    return "between " + exact_text(min->value) + " and " + exact_text(max->value);
  return (min->inclusive ? "at least " : "above ") + exact_text(min->value) + " and " +
         (max->inclusive ? "at most " : "below ") + exact_text(max->value);
}

}  // namespace psi_slam
