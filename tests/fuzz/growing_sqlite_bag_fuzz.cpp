// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "fuzz_target.h"
#include "logs/rosbag/bag_file.h"

/// Follows a ROS 2 bag in an SQLite file with a write-ahead log. The first byte is the number of pages of 512
/// bytes of the database; the log follows them.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  if (size == 0) return 0;
  const std::string_view bytes = fuzz::text_of(data + 1, size - 1);
  const std::size_t database_bytes = std::min<std::size_t>(std::size_t{data[0]} * 512, bytes.size());
  fuzz::accept_or_refuse([&] {
    const auto path = fuzz::file_with("input.db3", bytes.substr(0, database_bytes));
    fuzz::file_with("input.db3-wal", bytes.substr(database_bytes));
    BagRecorder recorder;
    recorder.should_stop = [] { return false; };
    recorder.wait = [](double) { return false; };
    recorder.is_closed = [] { return true; };
    const auto bag = follow_sqlite_bag(path, recorder);
    BagMessage message;
    for (int i = 0; i < 10'000 && bag->next(message); ++i) continue;
    (void)bag->topics();
    (void)bag->place();
  });
  return 0;
}
