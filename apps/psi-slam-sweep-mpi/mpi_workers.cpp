// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_workers.h"

namespace psi_slam {

SweepWorkers mpi_workers(const MpiWorld& world) {
  if (world.ranks() == 1) return local_workers(1);
  return [&world](const std::vector<SweepOrder>& orders, const SweepWatch& watch) {
    std::vector<std::string> texts;
    for (const SweepOrder& order : orders) texts.push_back(order_text(order));
    hand_out(world, texts, {watch.stop, watch.working, [&](std::size_t order, const std::string& outcome) {
                              watch.finished(order, read_outcome(outcome));
                            }});
  };
}

std::optional<std::string> make_sweep_run(const std::string& order, const std::function<bool()>& stop) {
  const std::optional<SweepOutcome> outcome = make_run(read_order(order), stop);
  if (!outcome) return std::nullopt;
  return outcome_text(*outcome);
}

}  // namespace psi_slam
