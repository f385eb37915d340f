// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "logs/carmen/carmen_stream.h"
#include "logs/rosbag/rosbag_stream.h"

/// Reads a stream: CARMEN lines if the first byte is even, a bag that is being recorded if it is odd.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  if (size == 0) return 0;
  constexpr double kLookOver_s = 5;
  const auto text = std::make_shared<const std::string>(fuzz::text_of(data + 1, size - 1));
  fuzz::accept_or_refuse([&] {
    auto stream = std::make_unique<TextSource>(text, "standard input");
    const auto reader = data[0] % 2 == 0 ? open_carmen_stream(std::move(stream), {}, kLookOver_s)
                                         : open_rosbag_stream(std::move(stream), {}, kLookOver_s);
    fuzz::read_frames(*reader);
  });
  return 0;
}
