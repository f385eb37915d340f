// SPDX-License-Identifier: BSD-3-Clause
// Replaces all forms of operator new, and the functions of MRPT for aligned memory, by versions that keep an
// AllocationLimit. For programs only: a library may not replace functions of its users. MRPT's own
// aligned_malloc() returns null if there is not enough memory, and MRPT's vectors of numbers do not check
// that.
#include <mrpt/core/aligned_allocator.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/allocation_limit.h"

using Size = std::size_t;

void* operator new(Size size, const std::nothrow_t&) noexcept {
  return psi_slam::AllocationLimit::take(size) ? std::malloc(std::max<Size>(size, 1)) : nullptr;
}
void* operator new(Size size, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  if (!psi_slam::AllocationLimit::take(size)) return nullptr;
  void* memory = nullptr;
  const int failed =
      posix_memalign(&memory, std::max(Size(alignment), sizeof(void*)), std::max<Size>(size, 1));
  return failed == 0 ? memory : nullptr;
}
void* operator new(Size size) {
  void* const memory = operator new(size, std::nothrow);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(Size size, std::align_val_t alignment) {
  void* const memory = operator new(size, alignment, std::nothrow);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

// clang-format off
void* operator new[](Size size) { return operator new(size); }
void* operator new[](Size size, std::align_val_t alignment) { return operator new(size, alignment); }
void* operator new[](Size size, const std::nothrow_t& nothrow) noexcept { return operator new(size, nothrow); }
void* operator new[](Size size, std::align_val_t alignment, const std::nothrow_t& nothrow) noexcept { return operator new(size, alignment, nothrow); }

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, Size) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, Size, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory, Size) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, Size, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t, const std::nothrow_t&) noexcept { std::free(memory); }
// clang-format on

void* mrpt::aligned_malloc(Size size, Size alignment) {
  return operator new(size, std::align_val_t(alignment));
}
void* mrpt::aligned_calloc(Size size, Size alignment) {
  return std::memset(aligned_malloc(size, alignment), 0, size);
}
void mrpt::aligned_free(void* memory) {
  std::free(memory);
}
