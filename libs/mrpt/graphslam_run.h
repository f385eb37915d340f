// SPDX-License-Identifier: BSD-3-Clause
// One run of MRPT's graph-slam engine over a log, with any of its deciders and ours:
//
//     GraphSlamRun run(setup, DeciderCatalogue());
//     while (run.step()) {}
//     run.finish();
//     run.write(folder);
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "mrpt/decider_catalogue.h"
#include "mrpt/graphslam_general.h"
#include "report/output_folder.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

struct GraphSlamSetup {
  std::filesystem::path ini;
  std::filesystem::path log;
  std::filesystem::path ground_truth;  ///< empty: none
  std::string node_decider = "CPsiFrontEndNRD";
  std::string edge_decider = "CPsiLoopCloserERD";
  std::string optimizer = "CPsiSpaGSO";
  bool visuals = false;  ///< MRPT's window; needs a display
};

class GraphSlamRun {
 public:
  /// Throws UserError when a file cannot be read, the settings are wrong, there is no decider of a name or
  /// they do not work together; SystemFailure when MRPT's engine gives up.
  GraphSlamRun(const GraphSlamSetup& setup, const DeciderCatalogue& catalogue);
  ~GraphSlamRun();
  GraphSlamRun(const GraphSlamRun&) = delete;
  GraphSlamRun& operator=(const GraphSlamRun&) = delete;

  /// Hands the next entry to the engine. False at the end of the log, where it breaks off (see broken_off()),
  /// and when the user wishes so in the window. Throws as the constructor when the log breaks off before its
  /// first scan, and when MRPT's engine gives up.
  bool step();
  double progress() const;

  /// What is wrong with the log, or with the true poses, behind the last entry that was mapped: a sentence.
  const std::optional<std::string>& broken_off() const;

  /// Once after the last step, be that the end of the log or not: see finish_deciders(). Throws UserError
  /// when our node decider has seen no scan.
  void finish(const std::function<bool(double)>& progress = {});

  /// Known after finish(): whether scans were left in the log, or finish() was told to end early.
  bool interrupted() const;

  /// Where the robot was at each scan, as the graph's poses have it now: of deciders of MRPT's from the node
  /// that was the newest then, as the decider saw the way from there.
  Trajectory trajectory() const;
  const MrptGraph& graph() const;
  std::size_t scans() const;
  /// Those that could not be matched, so that odometry stands for them; of our node decider only.
  std::size_t unmatched_scans() const;
  /// What the edge decider counts, by its own names; MRPT's call loops "LC".
  std::map<std::string, int> edge_counts() const;

  /// Writes trajectory.tum, and what the settings ask for, as MRPT's graphslam-engine does; each file appears
  /// whole or not at all. Throws SystemFailure when the disk does not take it, as far as MRPT tells.
  void write(const OutputFolder& folder);

  /// Until the user closes MRPT's window, if there is one.
  void wait_for_window();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
