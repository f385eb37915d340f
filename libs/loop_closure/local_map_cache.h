// SPDX-License-Identifier: BSD-3-Clause
// Cache of compressed local maps: all finished local maps are packed except those used last. Memory of a long
// run then grows with the length of its walls, not with the area of its local maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/worker_pool.h"
#include "local_maps/local_map.h"

namespace psi_slam {

class LocalMapCache {
 public:
  /// Packs local maps that are not in use when more than `most_unpacked` are unpacked.
  explicit LocalMapCache(std::size_t most_unpacked) : most_unpacked_(most_unpacked) {}

  /// Appends a finished local map; the first has number 0.
  void add(std::shared_ptr<LocalMap> map);

  /// Unpacks local maps by number, and packs those unused for longest. Any number of threads may read the
  /// unpacked ones until the next call. Ignores unknown numbers.
  void use(const std::vector<std::size_t>& maps, WorkerPool& pool);

  std::size_t unpacked() const { return unpacked_.size(); }

 private:
  void pack_all_but_the_last_used();

  struct Item {
    std::shared_ptr<LocalMap> map;
    std::uint64_t last_use = 0;
  };
  std::size_t most_unpacked_;
  std::vector<Item> items_;
  std::vector<std::size_t> unpacked_;
  std::uint64_t uses_ = 0;
};

}  // namespace psi_slam
