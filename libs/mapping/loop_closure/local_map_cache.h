// SPDX-License-Identifier: BSD-3-Clause
// Local map cache: packs all finished local maps except the most recently used ones. The memory of a long run
// then grows with the length of the mapped walls, not with the area of the local maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/worker_pool.h"
#include "mapping/local_maps/local_map.h"

namespace psi_slam {

class LocalMapCache {
 public:
  /// Keeps at most `most_unpacked` local maps unpacked, or more if one call of use() needs more.
  explicit LocalMapCache(std::size_t most_unpacked) : most_unpacked_(most_unpacked) {}

  /// Appends a finished local map. Local maps are numbered from 0.
  void add(std::shared_ptr<LocalMap> map);

  /// Unpacks the given local maps. If too many are then unpacked, packs those unused for longest. Ignores
  /// unknown numbers. Any number of threads may read the given maps until the next call of add() or use().
  void use(const std::vector<std::size_t>& maps, WorkerPool& pool);

  /// Frees a local map. Its number stays taken.
  void remove(std::size_t map);

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
