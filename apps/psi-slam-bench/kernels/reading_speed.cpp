// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/reading_speed.h"

#include <cstdint>
#include <vector>

#ifdef __x86_64__
#include <immintrin.h>
#endif

#include "base/instruction_set.h"
#include "common/processor_time.h"

namespace psi_slam {
namespace {

// Each function reads all bytes and returns whether one of them is not 0. Four registers collect the bytes,
// so that no instruction waits for the one before.
using Read = bool (*)(const std::uint64_t* words, std::size_t count);

bool read_words(const std::uint64_t* words, std::size_t count) {
  std::uint64_t found[4] = {};
  for (std::size_t i = 0; i < count; i += 4)
    for (std::size_t k = 0; k < 4; ++k) found[k] |= words[i + k];
  return (found[0] | found[1] | found[2] | found[3]) != 0;
}

#ifdef __x86_64__

__attribute__((target("avx2"))) bool read_by_avx2(const std::uint64_t* words, std::size_t count) {
  __m256i found[4] = {};
  const auto* vectors = reinterpret_cast<const __m256i*>(words);
  for (std::size_t i = 0; i < count / 4; i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      found[k] = _mm256_or_si256(found[k], _mm256_loadu_si256(vectors + i + k));
  const __m256i all =
      _mm256_or_si256(_mm256_or_si256(found[0], found[1]), _mm256_or_si256(found[2], found[3]));
  return _mm256_testz_si256(all, all) == 0;
}

__attribute__((target("avx512f"))) bool read_by_avx512(const std::uint64_t* words, std::size_t count) {
  __m512i found[4] = {};
  const auto* vectors = reinterpret_cast<const __m512i*>(words);
  for (std::size_t i = 0; i < count / 8; i += 4)
    for (std::size_t k = 0; k < 4; ++k)
      found[k] = _mm512_or_si512(found[k], _mm512_loadu_si512(vectors + i + k));
  const __m512i all =
      _mm512_or_si512(_mm512_or_si512(found[0], found[1]), _mm512_or_si512(found[2], found[3]));
  return _mm512_test_epi64_mask(all, all) != 0;
}

#endif

Read widest_read() {
#ifdef __x86_64__
  if (can_use(InstructionSet::kAvx512)) return &read_by_avx512;
  if (can_use(InstructionSet::kAvx2)) return &read_by_avx2;
#endif
  return &read_words;
}

}  // namespace

double reading_bytes_per_ns(std::size_t memory_bytes, std::size_t repeats) {
  constexpr std::size_t kBytesAMeasurement = 256 << 20;
  constexpr std::size_t kLine = 64;  // bytes of a cache line; vectors that cross two take twice as long
  const std::vector<std::uint8_t> memory(memory_bytes + kLine, 0);
  const auto address = reinterpret_cast<std::uintptr_t>(memory.data());
  const auto* words = reinterpret_cast<const std::uint64_t*>((address + kLine - 1) / kLine * kLine);
  const std::size_t rounds = kBytesAMeasurement / memory_bytes + 1;
  const Read read = widest_read();
  bool found = false;
  const double ms = least_ms(repeats, [&] {
    for (std::size_t i = 0; i < rounds; ++i) found = read(words, memory_bytes / sizeof *words) || found;
  });
  return found ? 0 : static_cast<double>(rounds * memory_bytes) / (1e6 * ms);
}

}  // namespace psi_slam
