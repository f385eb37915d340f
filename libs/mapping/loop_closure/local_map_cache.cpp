// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/local_map_cache.h"

#include <algorithm>
#include <utility>

namespace psi_slam {

void LocalMapCache::add(std::shared_ptr<LocalMap> map) {
  unpacked_.push_back(items_.size());
  items_.push_back({std::move(map), ++uses_});
  pack_all_but_the_last_used();
}

void LocalMapCache::use(const std::vector<std::size_t>& maps, WorkerPool& pool) {
  ++uses_;
  std::vector<std::size_t> packed;
  for (const std::size_t index : maps) {
    if (index >= items_.size() || !items_[index].map || items_[index].last_use == uses_) continue;
    items_[index].last_use = uses_;
    if (items_[index].map->packed()) packed.push_back(index);
  }
  pool.run(packed.size(), [&](std::size_t i) { items_[packed[i]].map->unpack(); });
  unpacked_.insert(unpacked_.end(), packed.begin(), packed.end());
  pack_all_but_the_last_used();
}

void LocalMapCache::remove(std::size_t map) {
  items_.at(map).map.reset();
  unpacked_.erase(std::remove(unpacked_.begin(), unpacked_.end(), map), unpacked_.end());
}

void LocalMapCache::pack_all_but_the_last_used() {
  if (unpacked_.size() <= most_unpacked_) return;
  std::sort(unpacked_.begin(), unpacked_.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(items_[a].last_use, a) > std::pair(items_[b].last_use, b);
  });
  while (unpacked_.size() > most_unpacked_ && items_[unpacked_.back()].last_use != uses_) {
    items_[unpacked_.back()].map->pack();
    unpacked_.pop_back();
  }
}

}  // namespace psi_slam
