// SPDX-License-Identifier: BSD-3-Clause
// One run of MRPT's graph-slam engine over a log, with any deciders of MRPT and psi-slam:
//
//     auto run = make_graphslam_run(setup, DeciderCatalogue());
//     while (run->step()) {}
//     run->finish();
//     run->write(folder);
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/graphslam_deciders.h"
#include "report/output_folder.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

struct DeciderDescription {
  std::string name;
  std::string description;
  std::string rawlog_format{};              ///< "Both", "#2 - Observation-only"; empty for optimizers
  std::vector<std::string> observations{};  ///< used by the decider
  bool is_ours = false;
};

/// The deciders and optimizers by name: those of MRPT for 2-D maps, and those of psi-slam.
class DeciderCatalogue {
 public:
  DeciderCatalogue();
  ~DeciderCatalogue();
  DeciderCatalogue(const DeciderCatalogue&) = delete;
  DeciderCatalogue& operator=(const DeciderCatalogue&) = delete;

  const std::vector<DeciderDescription>& node_deciders() const { return node_deciders_; }
  const std::vector<DeciderDescription>& edge_deciders() const { return edge_deciders_; }
  const std::vector<DeciderDescription>& optimizers() const { return optimizers_; }

  /// Throw UserError if the name is unknown.
  std::unique_ptr<NodeDecider> make_node_decider(const std::string& name) const;
  std::unique_ptr<EdgeDecider> make_edge_decider(const std::string& name) const;
  std::unique_ptr<GraphOptimizer> make_optimizer(const std::string& name) const;

 private:
  class Checker;  // MRPT's table, extended by psi-slam's classes
  std::unique_ptr<Checker> checker_;
  std::vector<DeciderDescription> node_deciders_;
  std::vector<DeciderDescription> edge_deciders_;
  std::vector<DeciderDescription> optimizers_;
};

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
  virtual ~GraphSlamRun() = default;

  /// Passes the next entry to the engine. False at the end of the log, at damage (see broken_off()), and when
  /// the user stops the run in the window. Throws UserError if the log is damaged before its first scan, and
  /// SystemFailure if MRPT's engine fails.
  virtual bool step() = 0;
  virtual double progress() const = 0;

  /// What is wrong with the log or the ground truth after the last mapped entry, as a sentence.
  virtual const std::optional<std::string>& broken_off() const = 0;

  /// Finishes the map, see finish_deciders(). Call once after the last step. Throws UserError if
  /// CPsiFrontEndNRD got no scan.
  virtual void finish(const std::function<bool(double)>& progress = {}) = 0;

  /// After finish(): whether the run stopped before the end of the log, or finish() was cut short.
  virtual bool interrupted() const = 0;

  /// Pose of the robot at each scan. With node deciders of MRPT it is the motion since the newest node at
  /// that time, applied to that node's present pose.
  virtual Trajectory trajectory() const = 0;
  virtual const MrptGraph& graph() const = 0;
  virtual std::size_t scans() const = 0;
  /// Scans that could not be matched, whose poses come from odometry. 0 with node deciders of MRPT.
  virtual std::size_t unmatched_scans() const = 0;
  /// Numbers of edges by type, as the edge decider names them; MRPT calls loops "LC".
  virtual std::map<std::string, int> edge_counts() const = 0;

  /// Writes trajectory.tum and the files that the settings request, as MRPT's graphslam-engine does. Each
  /// file appears complete or not at all. Throws SystemFailure if writing fails, as far as MRPT reports it.
  virtual void write(const OutputFolder& folder) = 0;

  /// Waits until the user closes MRPT's window, if there is one.
  virtual void wait_for_window() = 0;
};

/// Throws UserError if a file cannot be read, a setting is wrong, or a decider is unknown or does not work
/// with the others; SystemFailure if MRPT's engine fails.
std::unique_ptr<GraphSlamRun> make_graphslam_run(const GraphSlamSetup& setup,
                                                 const DeciderCatalogue& catalogue);

}  // namespace psi_slam
