// SPDX-License-Identifier: BSD-3-Clause
// The options of our deciders and our optimizer in the settings files of MRPT's graphslam-engine. There a key
// with a dot in it is one of psi-slam's options by its whole name, in the section of whom it belongs to:
//
//     [NodeRegistrationDeciderParameters]
//     front_end.node_distance_m = 0.15
//     class_verbosity = 1                 ; keys without a dot are MRPT's, which we leave to it
#pragma once

#include <filesystem>
#include <string>

#include "session/settings.h"

namespace psi_slam {

inline constexpr const char* kNodeDeciderSection = "NodeRegistrationDeciderParameters";
inline constexpr const char* kEdgeDeciderSection = "EdgeRegistrationDeciderParameters";
inline constexpr const char* kOptimizerSection = "OptimizerParameters";

/// The section that one of psi-slam's options, "front_end.window_m", is read from; "" for those without
/// effect there, such as how the map is drawn.
std::string graphslam_section_of(const std::string& option);

/// Takes all of psi-slam's options in the file. Throws UserError, with file and line, for an option that does
/// not exist, stands in another's section, has no effect there or does not take its value; and when two
/// contradict each other.
void load_graphslam_settings(const std::filesystem::path& ini, BoundSettings& bound);
Settings read_graphslam_settings(const std::filesystem::path& ini);

/// The options that are read from one of the sections, each with its description and its value now, as lines
/// of a settings file.
std::string graphslam_options_text(const OptionTable& table, const std::string& section);

}  // namespace psi_slam
