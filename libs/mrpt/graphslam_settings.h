// SPDX-License-Identifier: BSD-3-Clause
// Options of psi-slam's deciders and optimizer in the settings files of MRPT's graphslam-engine. A key with a
// dot is the full name of a psi-slam option. It stands in the section of the decider or optimizer that reads
// it:
//
//     [NodeRegistrationDeciderParameters]
//     front_end.node_distance_m = 0.15
//     class_verbosity = 1                 ; keys without a dot are MRPT's own
#pragma once

#include <mrpt/core/exceptions.h>
#include <mrpt/system/COutputLogger.h>

#include <filesystem>
#include <string>

#include "psi_slam/user_error.h"
#include "session/settings.h"

namespace psi_slam {

inline constexpr const char* kNodeDeciderSection = "NodeRegistrationDeciderParameters";
inline constexpr const char* kEdgeDeciderSection = "EdgeRegistrationDeciderParameters";
inline constexpr const char* kOptimizerSection = "OptimizerParameters";

/// The section of an option such as "front_end.node_distance_m". Empty for options without effect in the
/// engine, such as those of the map's drawing.
std::string graphslam_section_of(const std::string& option);

/// Reads all options of psi-slam in the file into `bound`. Throws UserError, with file and line, for an
/// option that is unknown, stands in a wrong section, has no effect in the engine or has an invalid value.
/// Also throws UserError if two options contradict each other.
void load_graphslam_settings(const std::filesystem::path& ini, BoundSettings& bound);
Settings read_graphslam_settings(const std::filesystem::path& ini);

/// The options of one section, each with its help and current value, as lines of a settings file.
std::string graphslam_options_text(const OptionTable& table, const std::string& section);

/// The settings that a decider or optimizer reads in loadParams().
struct DeciderParams {
  Settings settings;
  std::string text;                        ///< see graphslam_options_text()
  mrpt::system::VerbosityLevel verbosity;  ///< least severe level of messages to print
};
/// Reads all options, and the verbosity of one section. Throws PassedUserError for the errors of
/// load_graphslam_settings().
DeciderParams read_decider_params(const std::filesystem::path& ini, const std::string& section);

/// A UserError that passes through MRPT's engine. The engine passes only exceptions of its own kind and
/// replaces all others.
class PassedUserError : public UserError, public mrpt::ExceptionWithCallBackBase {
 public:
  explicit PassedUserError(const UserError& error)
      : UserError(error), mrpt::ExceptionWithCallBackBase(error.what(), mrpt::TCallStackBackTrace()) {}
};

/// Returns the result of `work`. Converts a UserError of `work` into a PassedUserError.
template <class Work>
auto through_engine(const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    throw PassedUserError(error);
  }
}

/// The section [GeneralConfiguration] of MRPT's graphslam-engine.
struct GraphSlamGeneral {
  std::string output_dir_fname = "graphslam_results";
  bool save_graph = true;
  std::string save_graph_fname = "output_graph.graph";
  bool save_map = true;
  std::string save_map_fname = "output_map";
  bool save_3DScene = true;
  std::string save_3DScene_fname = "scene.3DScene";
};

/// Reads the section [GeneralConfiguration]. Accepts keys that only MRPT's engine and deciders read, without
/// using them. Throws UserError, with file and line, for an unknown key or an invalid value.
GraphSlamGeneral read_graphslam_general(const std::filesystem::path& ini);

}  // namespace psi_slam
