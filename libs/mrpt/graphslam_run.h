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

#include "map/report/output_folder.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {

struct DeciderDescription {
  std::string name;
  std::string description;
  std::string rawlog_format{};  ///< MRPT's name for the rawlog format, such as "Both"; empty for optimizers
  std::vector<std::string> observations{};  ///< classes of observations that the decider uses
  bool is_ours = false;
};

/// The deciders and optimizers by name: those of MRPT for 2D maps, and those of psi-slam.
class DeciderCatalogue {
 public:
  DeciderCatalogue();
  ~DeciderCatalogue();
  DeciderCatalogue(const DeciderCatalogue&) = delete;
  DeciderCatalogue& operator=(const DeciderCatalogue&) = delete;

  const std::vector<DeciderDescription>& node_deciders() const { return node_deciders_; }
  const std::vector<DeciderDescription>& edge_deciders() const { return edge_deciders_; }
  const std::vector<DeciderDescription>& optimizers() const { return optimizers_; }

  /// Creates the decider or optimizer of this name. Throws UserError if the name is unknown.
  std::unique_ptr<NodeDecider> make_node_decider(const std::string& name) const;
  std::unique_ptr<EdgeDecider> make_edge_decider(const std::string& name) const;
  std::unique_ptr<GraphOptimizer> make_optimizer(const std::string& name) const;

 private:
  class Checker;  // MRPT's table of deciders and optimizers, with those of psi-slam added
  std::unique_ptr<Checker> checker_;
  std::vector<DeciderDescription> node_deciders_;
  std::vector<DeciderDescription> edge_deciders_;
  std::vector<DeciderDescription> optimizers_;
};

struct GraphSlamSetup {
  std::filesystem::path ini;
  std::filesystem::path log;
  std::filesystem::path ground_truth;  ///< empty if there is no ground truth
  std::string node_decider = "CPsiFrontEndNRD";
  std::string edge_decider = "CPsiLoopCloserERD";
  std::string optimizer = "CPsiSpaGSO";
  bool visuals = false;  ///< whether to open MRPT's window, which needs a display
};

class GraphSlamRun {
 public:
  virtual ~GraphSlamRun() = default;

  /// Passes the next entry to the engine. Returns false at the end of the log, if the log is damaged (see
  /// broken_off()), and when the user stops the run in the window. Throws UserError if the log is damaged
  /// before its first scan, and SystemFailure if MRPT's engine fails.
  virtual bool step() = 0;
  virtual double progress() const = 0;

  /// Error of the log or the ground truth file that ended the run after the last mapped entry, as a sentence.
  /// Empty without an error.
  virtual const std::optional<std::string>& broken_off() const = 0;

  /// Finishes the map, see finish_deciders(). Call once after the last step(). Throws UserError if no scan
  /// was read for CPsiFrontEndNRD.
  virtual void finish(const std::function<bool(double)>& progress = {}) = 0;

  /// After finish(): whether the run stopped before the end of the log, or finish() was cut short.
  virtual bool interrupted() const = 0;

  /// Pose of the robot at each scan. With MRPT's node deciders, it is the current pose of the node that was
  /// newest at that scan, plus the motion since that node.
  virtual Trajectory trajectory() const = 0;
  virtual const MrptGraph& graph() const = 0;
  virtual std::size_t scans() const = 0;
  /// Number of scans that could not be matched, whose poses come from odometry. 0 with MRPT's node deciders.
  virtual std::size_t unmatched_scans() const = 0;
  /// Number of edges of each type, as the edge decider names the types; MRPT calls loops "LC".
  virtual std::map<std::string, int> edge_counts() const = 0;

  /// Writes trajectory.tum and the files that the settings request, as MRPT's graphslam-engine does. Each
  /// file appears complete or not at all. Throws SystemFailure if writing fails, as far as MRPT reports it.
  virtual void write(const OutputFolder& folder) = 0;

  /// Waits until the user closes MRPT's window, if there is one.
  virtual void wait_for_window() = 0;
};

/// Prepares a run. Throws UserError if a file cannot be read, a setting is wrong, or a decider is unknown or
/// cannot be combined with the other deciders. Throws SystemFailure if MRPT's engine fails.
std::unique_ptr<GraphSlamRun> make_graphslam_run(const GraphSlamSetup& setup,
                                                 const DeciderCatalogue& catalogue);

}  // namespace psi_slam
