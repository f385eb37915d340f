// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/local_map_shelf.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

struct Shelf {
  LocalMapShelf shelf;
  std::vector<std::shared_ptr<LocalMap>> maps;
  WorkerPool pool{2};

  Shelf(std::size_t count, std::size_t most_unpacked) : shelf(most_unpacked) {
    for (std::size_t i = 0; i < count; ++i) {
      maps.push_back(std::make_shared<LocalMap>(LocalMapOptions()));
      maps.back()->finish();
      shelf.add(maps.back());
    }
  }

  std::vector<std::size_t> unpacked() const {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < maps.size(); ++i)
      if (!maps[i]->packed()) result.push_back(i);
    EXPECT_EQ(result.size(), shelf.unpacked());
    return result;
  }
};

using Numbers = std::vector<std::size_t>;

TEST(LocalMapShelf, leaves_those_unpacked_that_were_used_last) {
  Shelf shelf(5, 3);
  EXPECT_EQ(shelf.unpacked(), Numbers({2, 3, 4}));
  shelf.shelf.use({0, 3}, shelf.pool);
  EXPECT_EQ(shelf.unpacked(), Numbers({0, 3, 4}));
  shelf.shelf.use({1}, shelf.pool);
  EXPECT_EQ(shelf.unpacked(), Numbers({0, 1, 3}));
}

TEST(LocalMapShelf, what_is_in_use_is_unpacked_however_much_that_is) {
  Shelf shelf(6, 2);
  shelf.shelf.use({0, 1, 2, 3, 1}, shelf.pool);
  EXPECT_EQ(shelf.unpacked(), Numbers({0, 1, 2, 3}));
  shelf.shelf.use({}, shelf.pool);
  EXPECT_EQ(shelf.unpacked().size(), 2U);
  shelf.shelf.use({5, 17}, shelf.pool);
  EXPECT_FALSE(shelf.maps[5]->packed());
  EXPECT_EQ(shelf.unpacked().size(), 2U);
}

}  // namespace
}  // namespace psi_slam
