// SPDX-License-Identifier: BSD-3-Clause
// The only file that instantiates MRPT's deciders, which are templates.
#include <mrpt/graphslam/CGraphSlamEngine.h>
#include <mrpt/graphslam/ERD/CEmptyERD.h>
#include <mrpt/graphslam/ERD/CICPCriteriaERD.h>
#include <mrpt/graphslam/ERD/CLoopCloserERD.h>
#include <mrpt/graphslam/GSO/CEmptyGSO.h>
#include <mrpt/graphslam/GSO/CLevMarqGSO.h>
#include <mrpt/graphslam/NRD/CEmptyNRD.h>
#include <mrpt/graphslam/NRD/CFixedIntervalsNRD.h>
#include <mrpt/graphslam/NRD/CICPCriteriaNRD.h>
#include <mrpt/graphslam/apps_related/TUserOptionsChecker.h>

#include "base/config/nearest_name.h"
#include "mrpt/graphslam_run.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::graphslam::apps::TOptimizerProps;
using mrpt::graphslam::apps::TRegistrationDeciderProps;

/// An optimizer that does nothing. MRPT 2.5.8 leaves CEmptyGSO abstract, and creates a CLevMarqGSO under that
/// name.
class EmptyOptimizer : public mrpt::graphslam::optimizers::CEmptyGSO<MrptGraph> {
 protected:
  void optimizeGraph() override {}
};

template <class Makers>
auto made(const Makers& makers, const std::string& name, const std::string& what) {
  const auto maker = makers.find(name);
  if (maker != makers.end()) return maker->second();
  std::vector<std::string> names;
  for (const auto& one : makers) names.push_back(one.first);
  const auto near = nearest_name(name, names);
  throw UserError("there is no " + what + " \"" + name + '"' +
                  (near ? "; did you mean \"" + *near + "\"?" : " (see psi-graphslam --list-deciders)"));
}

}  // namespace

class DeciderCatalogue::Checker : public mrpt::graphslam::apps::TUserOptionsChecker<MrptGraph> {
 public:
  void createDeciderOptimizerMappings() override {
    TUserOptionsChecker::createDeciderOptimizerMappings();
    optimizers_map["CEmptyGSO"] = &createGraphSlamOptimizer<EmptyOptimizer>;
    node_regs_map["CPsiFrontEndNRD"] = &createNodeRegistrationDecider<CPsiFrontEndNRD>;
    edge_regs_map["CPsiLoopCloserERD"] = &createEdgeRegistrationDecider<CPsiLoopCloserERD>;
    optimizers_map["CPsiSpaGSO"] = &createGraphSlamOptimizer<CPsiSpaGSO>;
  }
};

DeciderCatalogue::DeciderCatalogue() : checker_(std::make_unique<Checker>()) {
  checker_->createDeciderOptimizerMappings();
  checker_->populateDeciderOptimizerProperties();
  for (const TRegistrationDeciderProps* decider : checker_->regs_descriptions)
    if (decider->is_slam_2d)
      (decider->type == "Node" ? node_deciders_ : edge_deciders_)
          .push_back(
              {decider->name, decider->description, decider->rawlog_format, decider->observations_used});
  for (const TOptimizerProps* optimizer : checker_->optimizers_descriptions)
    if (optimizer->is_slam_2d) optimizers_.push_back({optimizer->name, optimizer->description});
  const std::vector<std::string> observations{
      "CObservation2DRangeScan - Format #1, #2",
      "CActionRobotMovement2D - Format #1, CObservationOdometry - Format #2"};
  node_deciders_.push_back(
      {"CPsiFrontEndNRD",
       "Match each scan with a local map and register a node when the robot has moved or turned enough",
       "Both", observations, true});
  edge_deciders_.push_back(
      {"CPsiLoopCloserERD",
       "Close loops by matching nodes with local maps by the matcher that the factor Psi "
       "chooses; needs CPsiFrontEndNRD",
       "Both", observations, true});
  optimizers_.push_back(
      {"CPsiSpaGSO", "Sparse pose adjustment, for the edges of any deciders", "", {}, true});
}

DeciderCatalogue::~DeciderCatalogue() = default;

std::unique_ptr<NodeDecider> DeciderCatalogue::make_node_decider(const std::string& name) const {
  return std::unique_ptr<NodeDecider>(made(checker_->node_regs_map, name, "node decider"));
}

std::unique_ptr<EdgeDecider> DeciderCatalogue::make_edge_decider(const std::string& name) const {
  return std::unique_ptr<EdgeDecider>(made(checker_->edge_regs_map, name, "edge decider"));
}

std::unique_ptr<GraphOptimizer> DeciderCatalogue::make_optimizer(const std::string& name) const {
  return std::unique_ptr<GraphOptimizer>(made(checker_->optimizers_map, name, "optimizer"));
}

}  // namespace psi_slam
