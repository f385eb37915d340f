// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/outlier_loops.h"

#include <algorithm>
#include <cmath>

#include "loop_closure/inlier_loops.h"

namespace psi_slam {
namespace {

// Of the worst contradiction, what loops have at least that are switched off together with it.
constexpr double kShareOfWorst = 0.5;

std::vector<double> optimized_chi(PoseGraph& graph, SparsePoseAdjustment& solver,
                                  const std::vector<std::size_t>& loops) {
  const std::vector<ConstraintFit> fits = solver.optimize(graph).fits;
  std::vector<double> chi;
  for (const std::size_t loop : loops) chi.push_back(std::sqrt(fits[loop].chi2));
  return chi;
}

// Ends, since every round switches off one at least.
void switch_off_worst_first(PoseGraph& graph, SparsePoseAdjustment& solver,
                            const std::vector<std::size_t>& loops, double max_chi, std::vector<double>& chi) {
  while (true) {
    double worst = 0;
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (graph.enabled(loops[i])) worst = std::max(worst, chi[i]);
    if (worst <= max_chi) return;
    for (std::size_t i = 0; i < loops.size(); ++i)
      if (chi[i] > max_chi && chi[i] >= kShareOfWorst * worst) graph.set_enabled(loops[i], false);
    chi = optimized_chi(graph, solver, loops);
  }
}

double contradicted_share(const PoseGraph& graph, const std::vector<std::size_t>& loops, double max_chi,
                          const std::vector<double>& chi) {
  std::size_t on = 0;
  std::size_t contradicted = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!graph.enabled(loops[i])) continue;
    ++on;
    contradicted += chi[i] > max_chi ? 1 : 0;
  }
  return on == 0 ? 0 : static_cast<double>(contradicted) / static_cast<double>(on);
}

}  // namespace

std::vector<double> switch_off_outlier_loops(PoseGraph& graph, SparsePoseAdjustment& solver,
                                                  const std::vector<std::size_t>& loops, double max_chi,
                                                  double doubtful_share) {
  std::vector<double> chi = optimized_chi(graph, solver, loops);
  if (contradicted_share(graph, loops, max_chi, chi) > doubtful_share) {
    trust_loops(graph, solver, loops, max_chi);
    chi = optimized_chi(graph, solver, loops);
  }
  switch_off_worst_first(graph, solver, loops, max_chi, chi);
  bool any_fits_after_all = false;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (graph.enabled(loops[i]) || chi[i] > max_chi) continue;
    graph.set_enabled(loops[i], true);
    any_fits_after_all = true;
  }
  if (any_fits_after_all) {
    chi = optimized_chi(graph, solver, loops);
    switch_off_worst_first(graph, solver, loops, max_chi, chi);
  }
  return chi;
}

}  // namespace psi_slam
