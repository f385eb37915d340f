// SPDX-License-Identifier: BSD-3-Clause
// Where finished local maps lie packed, all but those that were used last: the memory of a long drive grows
// by what its walls need, not by the area of all local maps.
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
  /// Of so many local maps at most stay unpacked what is not in use.
  explicit LocalMapCache(std::size_t most_unpacked) : most_unpacked_(most_unpacked) {}

  /// Puts a finished local map there, whose number is the count of those before.
  void add(std::shared_ptr<LocalMap> map);

  /// Unpacks local maps by their numbers, ready for any number of threads to look at until the next call, and
  /// packs what has not been used for longest. Does nothing about numbers that the shelf does not have.
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
