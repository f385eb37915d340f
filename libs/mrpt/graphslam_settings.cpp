// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graphslam_settings.h"

#include <mrpt/config/CConfigFile.h>

#include <array>
#include <vector>

#include "base/config/ini_file.h"
#include "base/config/settings_text.h"

namespace psi_slam {
namespace {

struct Owner {
  const char* section;
  std::vector<std::string> options;  ///< names of psi-slam's sections or of single options
};

const std::array<Owner, 3> kOwners{
    {{kNodeDeciderSection, {"log", "front_end", "local_maps"}},
     {kEdgeDeciderSection, {"loop_closure", "psi", "genetic", "final_search", "joint_refinement", "run"}},
     {kOptimizerSection, {"pose_graph"}}}};

/// Whether an option has no effect in the engine, which reads every scan and draws its own map. The choice of
/// the edge decider replaces loop_closure.enabled.
bool has_no_effect(const std::string& option) {
  return option == "log.every_nth_scan" || option == "loop_closure.enabled" || option.rfind("map.", 0) == 0;
}

void require_own_section(const IniValue& value, const std::string& option) {
  const std::string section = graphslam_section_of(option);
  if (section.empty())
    throw UserError(value.where + ": " + value.key + " has no effect in MRPT's graph-slam engine. Remove it");
  if (section != value.section)
    throw UserError(value.where + ": " + value.key + " belongs in section [" + section + "], not in [" +
                    value.section + "]");
}

bool is_deciders_section(const std::string& section) {
  for (const Owner& owner : kOwners)
    if (section == owner.section) return true;
  return false;
}

constexpr const char* kGeneralSection = "GeneralConfiguration";

}  // namespace

std::string graphslam_section_of(const std::string& option) {
  if (has_no_effect(option)) return "";
  for (const Owner& owner : kOwners)
    for (const std::string& name : owner.options)
      if (option == name || option.substr(0, option.find('.')) == name) return owner.section;
  return "";
}

void load_graphslam_settings(const std::filesystem::path& ini, BoundSettings& bound) {
  IniFile options;
  for (const IniValue& value : read_ini(ini).values) {
    const std::size_t dot = value.key.find('.');
    if (!is_deciders_section(value.section) || dot == std::string::npos) continue;
    if (!bound.table.is_ignored(value.key))
      require_own_section(value, bound.table.option(value.key, value.where).name());
    options.values.push_back({value.key.substr(0, dot), value.key.substr(dot + 1), value.text, value.where});
  }
  apply(options, bound.table);
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
    for (const Option& option : described.options)
      if (graphslam_section_of(option.name()) == section) text += commented(option, option.name());
  return text;
}

DeciderParams read_decider_params(const std::filesystem::path& ini, const std::string& section) {
  BoundSettings bound;
  through_engine([&] { load_graphslam_settings(ini, bound); });
  const mrpt::config::CConfigFile file(ini.string());
  const int verbosity = file.read_int(section, "class_verbosity", mrpt::system::LVL_INFO, false);
  return {bound.settings, graphslam_options_text(bound.table, section),
          static_cast<mrpt::system::VerbosityLevel>(verbosity)};
}

GraphSlamGeneral read_graphslam_general(const std::filesystem::path& ini) {
  GraphSlamGeneral general;
  // Keys that psi-slam does not use, but that MRPT reads or MRPT's example files contain.
  bool user_decides_about_output_dir = false;
  std::string ground_truth_file_format = "NavSimul";
  int least_difference_of_nodes = 0;
  int class_verbosity = 1;
  OptionTable table;
  table.section(kGeneralSection, "Output files")
      .text("output_dir_fname", general.output_dir_fname, "folder for the results")
      .flag("save_graph", general.save_graph, "writes the graph")
      .text("save_graph_fname", general.save_graph_fname, "name of the graph file")
      .flag("save_map", general.save_map, "writes the map")
      .text("save_map_fname", general.save_map_fname, "prefix of the names of the map files")
      .flag("save_3DScene", general.save_3DScene, "writes the scene of the window, if there is a window")
      .text("save_3DScene_fname", general.save_3DScene_fname, "name of the scene file")
      .flag("user_decides_about_output_dir", user_decides_about_output_dir,
            "no effect: only --force overwrites files")
      .text("ground_truth_file_format", ground_truth_file_format, "format of the ground truth file")
      .integer("LC_min_nodeid_diff", least_difference_of_nodes, any_number(), "nodes",
               "smallest difference of node numbers for loops; read by MRPT's deciders")
      .integer("class_verbosity", class_verbosity, between(0, 4), "",
               "least severe level of the engine's messages to print");
  for (const IniValue& value : read_ini(ini).values)
    if (value.section == kGeneralSection) table.set(value.section + '.' + value.key, value.text, value.where);
  if (ground_truth_file_format != "NavSimul")
    throw UserError("ground_truth_file_format = " + ground_truth_file_format +
                    " is not supported. Set NavSimul, the only format of MRPT's engine.");
  return general;
}

}  // namespace psi_slam
