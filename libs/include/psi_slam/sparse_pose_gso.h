// SPDX-License-Identifier: BSD-3-Clause
// Our sparse pose adjustment as an optimizer of MRPT's graph-slam engine, for the edges of any deciders. The
// graph is optimised at once when a new edge is contradicted by more than five standard deviations; for
// smaller news only after it has grown by a thousandth.
//
// MRPT's engine sets all poses anew after each new node; ours come back with the next entry, and with
// finish() after the last one.
#pragma once

#include <mrpt/graphslam/interfaces/CGraphSlamOptimizer.h>

#include <memory>
#include <string>

#include "mrpt/shared_map.h"

namespace psi_slam {

class CPsiSpaGSO : public mrpt::graphslam::optimizers::CGraphSlamOptimizer<MrptGraph> {
 public:
  CPsiSpaGSO();
  ~CPsiSpaGSO() override;

  void loadParams(const std::string& source_fname) override;
  void printParams() const override;

  /// To be called before loadParams(): the map of the CPsiFrontEndNRD that makes the nodes.
  void share(std::shared_ptr<SharedMap> map);

  /// Throws UserError when nodes are not numbered from 0, or a node is not linked to the root.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;
  bool justFullyOptimizedGraph() const override { return just_optimized_; }
  void getDescriptiveReport(std::string* report_str) const override;

  /// After the last entry: optimises what is not yet, and leaves the poses in the graph.
  void finish();

 protected:
  void optimizeGraph() override;

 private:
  double contradiction_of_new_edges();
  bool is_time_to_optimize() const;

  std::shared_ptr<SharedMap> map_;
  std::size_t seen_edges_ = 0;
  std::size_t optimized_edges_ = 0;  ///< in the graph when it was optimised last
  std::size_t optimized_nodes_ = 0;
  double worst_residual_ = 0;                 ///< standard deviations, the most since then
  std::size_t nodes_in_graph_ = 0;  ///< at the last call
  bool stale_ = false;              ///< the engine has set the poses anew since then
  bool just_optimized_ = false;
  std::size_t optimizations_ = 0;
  std::string params_text_;
};

}  // namespace psi_slam
