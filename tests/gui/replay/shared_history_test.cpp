// SPDX-License-Identifier: BSD-3-Clause
#include "gui/shared_history.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace psi_slam {
namespace {

TEST(SharedHistory, a_view_shows_the_entries_at_the_time_it_was_made) {
  SharedHistory<std::string> history;
  EXPECT_TRUE(history.view().empty());
  history.push_back("one");
  const HistoryView<std::string> before = history.view();
  for (std::size_t i = 0; i < 3 * kHistoryBlock; ++i) history.push_back(std::to_string(i));
  EXPECT_EQ(before.size(), 1U);
  EXPECT_EQ(before.back(), "one");
  const HistoryView<std::string> after = history.view();
  ASSERT_EQ(after.size(), 3 * kHistoryBlock + 1);
  EXPECT_EQ(after[0], "one");
  EXPECT_EQ(after[kHistoryBlock], std::to_string(kHistoryBlock - 1));
  EXPECT_EQ(after.back(), std::to_string(3 * kHistoryBlock - 1));
}

TEST(SharedHistory, earlier_views_keep_the_values_of_a_replaced_block) {
  std::vector<int> values(kHistoryBlock + 1, 7);
  SharedHistory<int> history;
  for (const int value : values) history.push_back(value);
  const HistoryView<int> before = history.view();
  values[3] = 8;
  history.replace_block(0, values);
  EXPECT_EQ(before[3], 7);
  EXPECT_EQ(history.view()[3], 8);
  EXPECT_EQ(history.view()[kHistoryBlock], 7);
}

TEST(SharedHistory, views_outlive_the_history) {
  HistoryView<int> view;
  {
    SharedHistory<int> history;
    history.push_back(7);
    view = history.view();
  }
  EXPECT_EQ(view[0], 7);
}

TEST(SharedHistory, can_be_read_while_it_grows) {
  constexpr int kCount = 20'000;
  SharedHistory<int> history;
  std::mutex mutex;
  HistoryView<int> shared;
  std::atomic<bool> done{false};
  std::thread reader([&] {
    while (!done) {
      HistoryView<int> view;
      {
        const std::lock_guard lock(mutex);
        view = shared;
      }
      for (std::size_t i = 0; i < view.size(); ++i) ASSERT_EQ(view[i], static_cast<int>(i));
    }
  });
  for (int i = 0; i < kCount; ++i) {
    history.push_back(i);
    if (i % 100 != 0) continue;
    const std::lock_guard lock(mutex);
    shared = history.view();
  }
  done = true;
  reader.join();
  EXPECT_EQ(history.size(), static_cast<std::size_t>(kCount));
}

}  // namespace
}  // namespace psi_slam
