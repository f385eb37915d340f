// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace psi_slam {

/// Adds the function map().
void bind_map(pybind11::module_& module);

}  // namespace psi_slam
