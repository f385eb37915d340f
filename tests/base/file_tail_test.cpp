// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_tail.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <utility>

#include "full_disk.h"
#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

TEST(FileTail, continues_a_file_and_writes_all_waiting_bytes_after_a_failure) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  write_file(path, "head");
  FileTail tail(path, Descriptor(::open(path.c_str(), O_WRONLY)), 4);
  tail.append(" and");
  {
    const FullDisk full(6);
    EXPECT_THROW(tail.write(), SystemFailure);
    EXPECT_EQ(tail.unwritten_bytes(), 4);
  }
  tail.append(" tail");
  tail.write();
  EXPECT_EQ(tail.unwritten_bytes(), 0);
  EXPECT_EQ(read_file(path), "head and tail");
}

}  // namespace
}  // namespace psi_slam
