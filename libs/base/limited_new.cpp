// SPDX-License-Identifier: BSD-3-Clause
// Replaces operator new and mrpt::aligned_malloc() by versions that keep an AllocationLimit. For programs
// only: a library may not replace functions of its users. MRPT's own aligned_malloc() returns null if there
// is not enough memory, and MRPT's vectors of numbers do not check that.
#include <mrpt/core/aligned_allocator.h>

#include <cstdlib>
#include <new>

#include "base/allocation_limit.h"

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return psi_slam::AllocationLimit::take(size) ? std::malloc(size > 0 ? size : 1) : nullptr;
}
void* operator new(std::size_t size) {
  void* const memory = operator new(size, std::nothrow);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  void* memory = nullptr;
  if (!psi_slam::AllocationLimit::take(size) ||
      posix_memalign(&memory, std::size_t(alignment), size > 0 ? size : 1) != 0)
    throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

void* mrpt::aligned_malloc(std::size_t size, std::size_t alignment) {
  return operator new(size, std::align_val_t(alignment));
}
void mrpt::aligned_free(void* memory) {
  std::free(memory);
}
