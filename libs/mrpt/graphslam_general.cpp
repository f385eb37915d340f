// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graphslam_general.h"

#include "psi_slam/user_error.h"
#include "config/ini_file.h"
#include "config/option_table.h"

namespace psi_slam {
namespace {

constexpr const char* kSection = "GeneralConfiguration";

/// What MRPT reads, or has in the files that it ships with.
struct MrptsOwn {
  bool user_decides_about_output_dir = false;
  std::string ground_truth_file_format = "NavSimul";
  int LC_min_nodeid_diff = 0;
  int class_verbosity = 1;
};

void describe(OptionTable& table, GraphSlamGeneral& general, MrptsOwn& mrpt) {
  table.section(kSection, "What is written, and where")
      .text("output_dir_fname", general.output_dir_fname, "folder for the results")
      .flag("save_graph", general.save_graph, "write the graph")
      .text("save_graph_fname", general.save_graph_fname, "name of its file")
      .flag("save_map", general.save_map, "write the map")
      .text("save_map_fname", general.save_map_fname, "what the names of its files begin with")
      .flag("save_3DScene", general.save_3DScene, "write what the window shows, where there is one")
      .text("save_3DScene_fname", general.save_3DScene_fname, "name of its file")
      .flag("user_decides_about_output_dir", mrpt.user_decides_about_output_dir,
            "without effect: nothing is overwritten without --force")
      .text("ground_truth_file_format", mrpt.ground_truth_file_format, "of the file with the true poses")
      .integer("LC_min_nodeid_diff", mrpt.LC_min_nodeid_diff, any_number(), "nodes", "for MRPT's deciders")
      .integer("class_verbosity", mrpt.class_verbosity, between(0, 4), "", "of the engine's messages");
}

}  // namespace

GraphSlamGeneral read_graphslam_general(const std::filesystem::path& ini) {
  GraphSlamGeneral general;
  MrptsOwn mrpt;
  OptionTable table;
  describe(table, general, mrpt);
  for (const IniValue& value : read_ini(ini).values)
    if (value.section == kSection) table.set(value.section + '.' + value.key, value.text, value.where);
  if (mrpt.ground_truth_file_format != "NavSimul")
    throw UserError("ground_truth_file_format = " + mrpt.ground_truth_file_format +
                    " is not read: MRPT's engine has NavSimul only");
  return general;
}

}  // namespace psi_slam
