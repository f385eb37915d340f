// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace psi_slam {

/// Number of entries in a block of a SharedHistory.
inline constexpr std::size_t kHistoryBlock = 512;

/// The entries of a SharedHistory at one moment. They live as long as any view of them.
template <class T>
class HistoryView {
 public:
  using Block = std::array<T, kHistoryBlock>;

  HistoryView() = default;
  HistoryView(std::vector<std::shared_ptr<const Block>> blocks, std::size_t size)
      : blocks_(std::move(blocks)), size_(size) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](std::size_t index) const {
    return (*blocks_[index / kHistoryBlock])[index % kHistoryBlock];
  }
  const T& back() const { return (*this)[size_ - 1]; }

 private:
  std::vector<std::shared_ptr<const Block>> blocks_;
  std::size_t size_ = 0;
};

/// A list that one thread appends to while other threads read views of its earlier entries. A view copies
/// only the list of blocks. Callers must synchronise when they pass a view to another thread.
template <class T>
class SharedHistory {
 public:
  std::size_t size() const { return size_; }

  void push_back(T value) {
    if (size_ % kHistoryBlock == 0) blocks_.push_back(std::make_shared<typename HistoryView<T>::Block>());
    (*blocks_.back())[size_ % kHistoryBlock] = std::move(value);
    ++size_;
  }

  /// Replaces the values of a full block by those of `all` at the same places. Earlier views keep the old
  /// values.
  void replace_block(std::size_t block, const std::vector<T>& all) {
    blocks_[block] = std::make_shared<typename HistoryView<T>::Block>();
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(block * kHistoryBlock), kHistoryBlock,
                blocks_[block]->begin());
  }

  HistoryView<T> view() const { return {{blocks_.begin(), blocks_.end()}, size_}; }

 private:
  std::vector<std::shared_ptr<typename HistoryView<T>::Block>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace psi_slam
