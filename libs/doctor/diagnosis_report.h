// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "doctor/input_doctor.h"

namespace psi_slam {

/// Facts about the log, one per line.
std::vector<std::string> describe_facts(const LogDiagnosis& diagnosis);

/// Table of the beam angle study, one convention per line, the best marked. Empty without a study.
std::vector<std::string> describe_beam_angles(const BeamAngleStudy& study);

/// Facts, beam angles and findings with their remedies, as `psi-slam check` prints them.
std::vector<std::string> describe(const LogDiagnosis& diagnosis);

/// All measurements and findings as JSON, in SI units with the unit in each key.
nlohmann::ordered_json to_json(const LogDiagnosis& diagnosis);

}  // namespace psi_slam
