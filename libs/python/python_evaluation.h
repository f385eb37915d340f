// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace psi_slam {

/// Adds the function evaluate() and its classes.
void bind_evaluation(pybind11::module_& module);

}  // namespace psi_slam
