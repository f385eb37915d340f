// SPDX-License-Identifier: BSD-3-Clause
#include <new>

#include "fuzz_target.h"
#include "psi_slam/open_log.h"

namespace {

constexpr std::size_t kLargestAllocation_bytes = std::size_t{256} << 20;

}  // namespace

// MRPT allocates the number of elements that an object states before it reads them. libFuzzer would stop at
// each such object, so large allocations fail here as they do on a small computer.
void* operator new(std::size_t size) {
  void* memory = size <= kLargestAllocation_bytes ? std::malloc(size > 0 ? size : 1) : nullptr;
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

/// Options of the address sanitizer: its operator new for std::nothrow belongs to the operator delete above.
extern "C" const char* __asan_default_options() {
  return "alloc_dealloc_mismatch=0";
}

/// Reads a rawlog of MRPT.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  fuzz::accept_or_refuse([&] {
    const auto path = fuzz::file_with("input.rawlog", fuzz::text_of(data, size));
    fuzz::read_frames(*open_log(path));
  });
  return 0;
}
