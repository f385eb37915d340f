// SPDX-License-Identifier: BSD-3-Clause
// The deciders and optimizers by name: those of MRPT for 2-D maps, and those of psi-slam.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "psi_slam/graphslam_deciders.h"

namespace psi_slam {

struct DeciderDescription {
  std::string name;
  std::string description;
  std::string rawlog_format;              ///< "Both", "#2 - Observation-only"; empty for optimizers
  std::vector<std::string> observations;  ///< used by the decider
  bool is_ours = false;
};

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

}  // namespace psi_slam
