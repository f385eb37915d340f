// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "doctor/input_doctor.h"

namespace psi_slam {

/// What the log holds, in plain sentences, one a line.
std::vector<std::string> describe_facts(const LogDiagnosis& diagnosis);

/// The table of the beam-angle study, one convention a line, the best marked; empty when nothing was studied.
std::vector<std::string> describe_beam_angles(const BeamAngleStudy& study);

/// Facts, beam angles and findings with their remedies: what `psi-slam check` prints.
std::vector<std::string> describe(const LogDiagnosis& diagnosis);

/// The same for programs, in SI units with the unit in each key.
nlohmann::ordered_json to_json(const LogDiagnosis& diagnosis);

}  // namespace psi_slam
