// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Adapters for MRPT's graph-slam engine: the front end as a node registration decider, loop closing as an
/// edge registration decider, and sparse pose adjustment as an optimizer.
///
///     connect_deciders(node_decider, edge_decider, optimizer);
///     mrpt::graphslam::CGraphSlamEngine<MrptGraph> engine(ini, rawlog, "", nullptr, &node_decider, ...);
///     engine._execGraphSlamStep(...);  // for each entry
///     finish_deciders(node_decider, edge_decider, optimizer);
///
/// Each class has options in its own section of the engine's `.ini` file. Errors are of class UserError and
/// pass through the engine.
#pragma once

#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/interfaces/CEdgeRegistrationDecider.h>
#include <mrpt/graphslam/interfaces/CGraphSlamOptimizer.h>
#include <mrpt/graphslam/interfaces/CNodeRegistrationDecider.h>

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "psi_slam/log_options.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Graph of MRPT's engine: nodes with SE(2) poses, edges with information matrices.
using MrptGraph = mrpt::graphs::CNetworkOfPoses2DInf;
/// Base class of node registration deciders.
using NodeDecider = mrpt::graphslam::deciders::CNodeRegistrationDecider<MrptGraph>;
/// Base class of edge registration deciders.
using EdgeDecider = mrpt::graphslam::deciders::CEdgeRegistrationDecider<MrptGraph>;
/// Base class of optimizers.
using GraphOptimizer = mrpt::graphslam::optimizers::CGraphSlamOptimizer<MrptGraph>;

/// Data that the three classes share; connect_deciders() gives all of them the same.
struct SharedMap;

/// Matches each scan with the active local map. Registers a node when the robot has moved or turned enough.
///
/// The edges of a node lead to the anchors of the local maps that hold its scan, not to the node before.
/// Scans matched with one map share its errors, so additional edges between neighbours would count them
/// twice. The engine takes the first two nodes together and then one node per entry; a second node that is
/// ready waits for the next entry.
class CPsiFrontEndNRD : public NodeDecider {
 public:
  CPsiFrontEndNRD();
  ~CPsiFrontEndNRD() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Replaces the log options of the `.ini` file, for entries made from a log that was already read.
  void set_log_options(const LogOptions& options);

  /// Throws UserError if a scan has no time stamp or no rays, its laser is tilted, or odometry is missing.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  /// Appends the state of the object as text for people.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Maps the scans that still wait, and finishes the active local maps. Call after the last entry.
  void finish();

  /// All scans, with poses from the nodes of the graph.
  std::vector<FrameRecord> frames() const;

  /// Number of scans that could not be matched; their poses come from odometry.
  std::size_t unmatched() const;

  /// The data that connect_deciders() hands to the other classes.
  const std::shared_ptr<SharedMap>& shared_map() const { return map_; }

 protected:
  /// Registers the scan matched last, unless it is the very first.
  bool checkRegistrationCondition() override;

 private:
  bool add(const Frame& frame);
  void add_node();

  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Matches each new node with the local maps near it by the matcher that the factor Psi chooses, and verifies
/// the match. A match in a wide window waits until others agree. Needs the local maps of CPsiFrontEndNRD.
///
/// The engine does not tell when a log ends: call finish_deciders() then. Without it the final loop search is
/// missing.
class CPsiLoopCloserERD : public EdgeDecider {
 public:
  CPsiLoopCloserERD();
  ~CPsiLoopCloserERD() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Takes the map of CPsiFrontEndNRD. Call before the first entry.
  void share(std::shared_ptr<SharedMap> map) { map_ = std::move(map); }

  /// Throws UserError if there is no shared map.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;

  /// Sets "LC" and "ICP2D", the engine's names for loops, to the number of accepted loops.
  void getEdgesStats(std::map<std::string, int>* edge_type_to_num) const override;
  /// Appends the state of the object as text for people.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Runs the final loop search, removes outlier loops, and refines the scans of all nodes jointly. Call
  /// after the last entry and the node decider's finish(). Without CPsiSpaGSO it only refuses pending loops.
  /// `progress` gets the share done; if it returns false, the remaining steps are left out.
  void finish(const std::function<bool(double)>& progress = {});

  /// All attempts to close loops.
  const std::vector<LoopRecord>& loops() const;
  /// Number of loops that are constraints of the graph.
  std::size_t accepted_loops() const;

 private:
  SharedMap& map() const;
  std::size_t close_loops_of_new_nodes();

  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Sparse pose adjustment for the edges of any deciders. Optimises at once when the graph contradicts a new
/// edge by five or more standard deviations; for smaller residuals after the graph has grown by a thousandth.
///
/// The engine resets all poses after each new node. Optimised poses return with the next entry, and with
/// finish() after the last one.
class CPsiSpaGSO : public GraphOptimizer {
 public:
  CPsiSpaGSO();
  ~CPsiSpaGSO() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Takes the map of CPsiFrontEndNRD. Call before loadParams().
  void share(std::shared_ptr<SharedMap> map);

  /// Throws UserError if nodes are not numbered from 0 without a gap, or a node is not linked to the root.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  /// Whether the last updateState() optimised the graph.
  bool justFullyOptimizedGraph() const override;
  /// Appends the state of the object as text for people.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Optimises if constraints came since the last time, and leaves the poses in the graph. Call after the
  /// last entry.
  void finish();

 protected:
  /// Optimises the graph now.
  void optimizeGraph() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Lets those of the three that are of psi-slam share one map. Throws UserError if the edge decider is
/// CPsiLoopCloserERD and the node decider is not CPsiFrontEndNRD.
void connect_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer);

/// Finishes those of the three that are of psi-slam. Call after the last entry, when the engine is at rest.
/// `progress` is that of CPsiLoopCloserERD::finish().
void finish_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer,
                     const std::function<bool(double)>& progress = {});

}  // namespace psi_slam
