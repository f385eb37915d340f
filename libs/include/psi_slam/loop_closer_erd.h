// SPDX-License-Identifier: BSD-3-Clause
// Our loop closing as an edge registration decider of MRPT's graph-slam engine: each new node is matched with
// the local maps near it by the matcher that the factor Psi picks, verified, and where its window is wide,
// held back until others agree. It needs the local maps of CPsiFrontEndNRD: see connect_deciders().
//
// The engine never says that the log has ended. Who drives it calls finish() then, for the last pass; without
// it the map is that of the last entry.
#pragma once

#include <mrpt/graphslam/interfaces/CEdgeRegistrationDecider.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "mrpt/shared_map.h"
#include "loop_closure/back_end.h"
#include "mapping/joint_refinement.h"

namespace psi_slam {

class CPsiLoopCloserERD : public mrpt::graphslam::deciders::CEdgeRegistrationDecider<MrptGraph> {
 public:
  CPsiLoopCloserERD();
  ~CPsiLoopCloserERD() override;

  void loadParams(const std::string& source_fname) override;
  void printParams() const override;

  /// To be called before the first entry: the map of the CPsiFrontEndNRD that makes the nodes.
  void share(std::shared_ptr<SharedMap> map) { map_ = std::move(map); }

  /// Throws UserError when there is no shared map.
  bool updateState(mrpt::obs::CActionCollection::Ptr action, mrpt::obs::CSensoryFrame::Ptr observations,
                   mrpt::obs::CObservation::Ptr observation) override;

  void getEdgesStats(std::map<std::string, int>* edge_type_to_num) const override;
  void getDescriptiveReport(std::string* report_str) const override;

  /// After the last entry and the node decider's finish(): the last pass over all pairs near each other, the
  /// removal of loops that the graph contradicts, and the refinement of all nodes' scans on each other. All
  /// this needs CPsiSpaGSO; with another optimizer loops that still wait are refused, and that is all.
  /// `progress` is told the share done; when it returns false, the search ends there.
  void finish(const std::function<bool(double)>& progress = {});

  /// What became of every loop that was found.
  const std::vector<LoopRecord>& loops() const { return back_end_->loops(); }
  std::size_t accepted_loops() const { return back_end_->accepted(); }

 private:
  SharedMap& map() const;
  std::size_t close_loops_of_new_nodes();
  void refine(const std::function<bool(double)>& progress);

  std::unique_ptr<BackEnd> back_end_;
  std::shared_ptr<SharedMap> map_;
  int passes_ = 0;
  JointRefinementOptions refinement_;
  std::size_t handled_nodes_ = 0;
  double odometry_m_ = 0;  ///< of the node handled last
  std::string params_text_;
};

}  // namespace psi_slam
