// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Adapters for MRPT's graph-slam engine. The front end becomes a node registration decider, loop closing an
/// edge registration decider, and sparse pose adjustment an optimizer.
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

/// Map data of the node decider, the edge decider and the optimizer. connect_deciders() makes them share one
/// object.
struct SharedMap;

/// Matches each scan with the active local map. Registers a node when the robot has moved or turned enough.
///
/// An edge connects a node with the first node of its path segment of 3 m, not with the previous node: scans
/// of a segment share its errors. The engine registers the first two nodes together, then one node per entry.
/// If an entry yields a second node, that node waits for the next entry.
class CPsiFrontEndNRD : public NodeDecider {
 public:
  CPsiFrontEndNRD();
  ~CPsiFrontEndNRD() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Replaces the log options of the `.ini` file. Use it if the entries were converted from frames that
  /// open_log() read.
  void set_log_options(const LogOptions& options);

  /// Matches the scans of one entry. Returns true if a node was registered. Throws UserError if a scan has no
  /// time stamp or no rays, its laser is tilted, or odometry is missing.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  /// Appends the state of the node decider as readable text.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Maps the scans that still wait for odometry or a companion scan, and finishes the active local maps.
  /// Call after the last entry.
  void finish();

  /// Returns the records of all scans, with poses interpolated between the nodes of the graph.
  std::vector<FrameRecord> frames() const;

  /// Number of scans that matched no local map although one existed. Their poses come from odometry.
  std::size_t unmatched() const;

  /// The map data that connect_deciders() passes to the edge decider and the optimizer.
  const std::shared_ptr<SharedMap>& shared_map() const { return map_; }

 protected:
  /// Returns true if the last scan became a node that the engine must register now. Returns false for the
  /// first node, which the engine registers together with the second.
  bool checkRegistrationCondition() override;

 private:
  bool add(const Frame& frame);
  void add_node();

  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Matches the scan of each new node with the local maps near the node and verifies each match. The factor
/// Psi chooses the matcher. A match in a wide window waits until other matches agree. Needs the local maps of
/// CPsiFrontEndNRD.
///
/// The engine does not signal the end of a log. Call finish_deciders() after the last entry; otherwise the
/// final loop search is missing.
class CPsiLoopCloserERD : public EdgeDecider {
 public:
  CPsiLoopCloserERD();
  ~CPsiLoopCloserERD() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Takes the shared map data of CPsiFrontEndNRD. Call before the first entry.
  void share(std::shared_ptr<SharedMap> map) { map_ = std::move(map); }

  /// Closes the loops of the new nodes. Always returns true. Throws UserError if share() was not called.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;

  /// Sets "LC" and "ICP2D", the engine's names for loops, to the number of accepted loops.
  void getEdgesStats(std::map<std::string, int>* edge_type_to_num) const override;
  /// Appends the state of the edge decider as readable text.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Runs the final loop search, removes outlier loops, and refines the scans of all nodes jointly. Call
  /// after the last entry and the node decider's finish(). Without CPsiSpaGSO it only rejects candidates.
  /// `progress` gets the completed share of the work, in [0, 1]; if it returns false, the remaining steps are
  /// skipped.
  void finish(const std::function<bool(double)>& progress = {});

  /// Returns the records of all attempts to close loops. Needs loadParams().
  const std::vector<LoopRecord>& loops() const;
  /// Number of accepted loops, which are constraints of the graph. Needs loadParams().
  std::size_t accepted_loops() const;

 private:
  SharedMap& map() const;
  std::size_t close_loops_of_new_nodes();

  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Optimises the graph by sparse pose adjustment, for the edges of any deciders. Optimises at once when the
/// graph contradicts a new edge by five or more standard deviations. Residuals between one and five wait
/// until the graph has grown by a thousandth. Smaller residuals alone cause no optimisation.
///
/// The engine resets all poses after each new node. The next entry restores the optimised poses; finish()
/// restores them after the last entry.
class CPsiSpaGSO : public GraphOptimizer {
 public:
  CPsiSpaGSO();
  ~CPsiSpaGSO() override;

  /// Reads the options in an `.ini` file. Throws UserError for unknown options and invalid values.
  void loadParams(const std::string& source_fname) override;
  /// Prints the options in use.
  void printParams() const override;

  /// Takes the shared map data of CPsiFrontEndNRD. Call before loadParams().
  void share(std::shared_ptr<SharedMap> map);

  /// Optimises the graph if new edges make it necessary. Throws UserError if nodes are not numbered from 0
  /// without a gap, or if a node is not linked to the root.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  /// Returns whether the last updateState() optimised the graph.
  bool justFullyOptimizedGraph() const override;
  /// Appends the state of the optimizer as readable text.
  void getDescriptiveReport(std::string* report_str) const override;

  /// Optimises the graph if edges were added since the last optimisation, and writes the poses to the graph.
  /// Call after the last entry.
  void finish();

 protected:
  /// Optimises the graph now.
  void optimizeGraph() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::shared_ptr<SharedMap> map_;
};

/// Makes the psi-slam classes among the three arguments share one map. Throws UserError if the edge decider
/// is CPsiLoopCloserERD and the node decider is not CPsiFrontEndNRD.
void connect_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer);

/// Finishes the psi-slam classes among the three arguments. Call after the last entry, when the engine is
/// idle. `progress` is passed to CPsiLoopCloserERD::finish().
void finish_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer,
                     const std::function<bool(double)>& progress = {});

}  // namespace psi_slam
