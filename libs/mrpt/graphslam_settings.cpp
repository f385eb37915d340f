// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graphslam_settings.h"

#include <mrpt/config/CConfigFile.h>

#include <array>
#include <vector>

#include "psi_slam/user_error.h"
#include "config/ini_file.h"

namespace psi_slam {
namespace {

struct Owner {
  const char* section;
  std::vector<std::string> options;  ///< sections of psi-slam, or single options
};

const std::array<Owner, 3>& owners() {
  static const std::array<Owner, 3> kOwners{
      {{kNodeDeciderSection,
        {"log", "front_end", "local_maps", "pose_graph.local_map_sigma_m",
         "pose_graph.local_map_sigma_theta_deg"}},
       {kEdgeDeciderSection,
        {"loop_closure", "psi", "genetic", "verification", "consensus", "final_search", "joint_refinement",
         "run", "pose_graph.loop_sigma_m", "pose_graph.loop_sigma_theta_deg", "pose_graph.max_loop_chi"}},
       {kOptimizerSection, {"pose_graph"}}}};
  return kOwners;
}

/// Options without effect in the engine: it reads every scan, and the edge decider decides on loop closing.
bool has_no_effect(const std::string& option) {
  return option == "log.every_nth_scan" || option == "loop_closure.enabled" || option.rfind("map.", 0) == 0;
}

void require_own_section(const IniValue& value, const std::string& option) {
  const std::string section = graphslam_section_of(option);
  if (section.empty())
    throw UserError(value.where + ": " + value.key + " has no effect in MRPT's graph-slam engine");
  if (section != value.section)
    throw UserError(value.where + ": " + value.key + " belongs in section [" + section + "], not in [" +
                    value.section + "]");
}

bool is_deciders_section(const std::string& section) {
  for (const Owner& owner : owners())
    if (section == owner.section) return true;
  return false;
}

}  // namespace

std::string graphslam_section_of(const std::string& option) {
  if (has_no_effect(option)) return "";
  for (const Owner& owner : owners())
    for (const std::string& name : owner.options)
      if (option == name || option.substr(0, option.find('.')) == name) return owner.section;
  return "";
}

void load_graphslam_settings(const std::filesystem::path& ini, BoundSettings& bound) {
  for (const IniValue& value : read_ini(ini).values) {
    if (!is_deciders_section(value.section) || value.key.find('.') == std::string::npos) continue;
    require_own_section(value, bound.table.option(value.key, value.where).name());
    bound.table.set(value.key, value.text, value.where);
  }
  check(bound.settings);
}

Settings read_graphslam_settings(const std::filesystem::path& ini) {
  BoundSettings bound;
  load_graphslam_settings(ini, bound);
  return bound.settings;
}

std::string graphslam_options_text(const OptionTable& table, const std::string& section) {
  std::string text;
  for (const OptionSection& described : table.sections())
    for (const Option& option : described.options) {
      if (graphslam_section_of(option.name()) != section) continue;
      text += "\n; " + option.help + "\n; " + option.values() + "; default " +
              ini_value_text(option.default_text) + '\n' + option.name() + " = " +
              ini_value_text(option.text()) + '\n';
    }
  return text;
}

DeciderParams read_decider_params(const std::filesystem::path& ini, const std::string& section) {
  BoundSettings bound;
  load_graphslam_settings(ini, bound);
  const mrpt::config::CConfigFile file(ini.string());
  const int verbosity = file.read_int(section, "class_verbosity", mrpt::system::LVL_INFO, false);
  return {bound.settings, graphslam_options_text(bound.table, section),
          static_cast<mrpt::system::VerbosityLevel>(verbosity)};
}

}  // namespace psi_slam
