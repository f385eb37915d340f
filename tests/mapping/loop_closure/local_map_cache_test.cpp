// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/local_map_cache.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

struct Shelf {
  LocalMapCache cache;
  std::vector<std::shared_ptr<LocalMap>> maps;
  WorkerPool pool{2};

  Shelf(std::size_t count, std::size_t most_unpacked) : cache(most_unpacked) {
    for (std::size_t i = 0; i < count; ++i) {
      maps.push_back(std::make_shared<LocalMap>(LocalMapOptions()));
      maps.back()->finish();
      cache.add(maps.back());
    }
  }

  std::vector<std::size_t> unpacked() const {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < maps.size(); ++i)
      if (!maps[i]->packed()) result.push_back(i);
    EXPECT_EQ(result.size(), cache.unpacked());
    return result;
  }
};

using Numbers = std::vector<std::size_t>;

TEST(LocalMapCache, keeps_the_local_maps_used_last_unpacked) {
  Shelf cache(5, 3);
  EXPECT_EQ(cache.unpacked(), Numbers({2, 3, 4}));
  cache.cache.use({0, 3}, cache.pool);
  EXPECT_EQ(cache.unpacked(), Numbers({0, 3, 4}));
  cache.cache.use({1}, cache.pool);
  EXPECT_EQ(cache.unpacked(), Numbers({0, 1, 3}));
}

TEST(LocalMapCache, keeps_all_local_maps_in_use_unpacked) {
  Shelf cache(6, 2);
  cache.cache.use({0, 1, 2, 3, 1}, cache.pool);
  EXPECT_EQ(cache.unpacked(), Numbers({0, 1, 2, 3}));
  cache.cache.use({}, cache.pool);
  EXPECT_EQ(cache.unpacked().size(), 2U);
  cache.cache.use({5, 17}, cache.pool);
  EXPECT_FALSE(cache.maps[5]->packed());
  EXPECT_EQ(cache.unpacked().size(), 2U);
}

}  // namespace
}  // namespace psi_slam
