// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/relations_metric.h"

#include "fuzz_target.h"

/// Reads the relations of a benchmark.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse(
      [&] { read_relations(fuzz::file_with("input.relations", fuzz::text_of(data, size))); });
  return 0;
}
