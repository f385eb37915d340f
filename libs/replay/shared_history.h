// SPDX-License-Identifier: BSD-3-Clause
// A list that one thread appends to while others read what was there when they were given a view of it:
// nothing is copied but the list of its blocks. How a view comes from the one thread to the others is theirs
// to synchronise.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace psi_slam {

inline constexpr std::size_t kHistoryBlock = 512;

/// The entries of a SharedHistory at one moment; they live as long as any view of them.
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

template <class T>
class SharedHistory {
 public:
  std::size_t size() const { return size_; }

  void push_back(T value) {
    if (size_ % kHistoryBlock == 0) blocks_.push_back(std::make_shared<typename HistoryView<T>::Block>());
    (*blocks_.back())[size_ % kHistoryBlock] = std::move(value);
    ++size_;
  }

  HistoryView<T> view() const { return {{blocks_.begin(), blocks_.end()}, size_}; }

 private:
  std::vector<std::shared_ptr<typename HistoryView<T>::Block>> blocks_;
  std::size_t size_ = 0;
};

}  // namespace psi_slam
