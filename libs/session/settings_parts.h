// SPDX-License-Identifier: BSD-3-Clause
// Parts of describe() of settings.h that describe some of the sections.
#pragma once

#include "config/option_table.h"
#include "session/settings.h"

namespace psi_slam {

/// Describes the options refine_* in the current section of the table.
void describe_refinement(OptionTable& table, RefinementOptions& refinement);

/// Describes the sections from [loop_closure] to [joint_refinement].
void describe_loops(OptionTable& table, MapperOptions& mapper);

}  // namespace psi_slam
