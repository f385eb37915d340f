// SPDX-License-Identifier: BSD-3-Clause
#include "batch/kept_run.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

TEST(KeptRun, is_found_by_its_key_unless_the_machine_was_busier) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "run.json";
  EXPECT_FALSE(kept_run(file, {"key", 1}));
  keep_run(file, {"key", 2}, {{"figure", 7}});
  EXPECT_EQ(kept_run(file, {"key", 2}).value().at("figure"), 7);
  EXPECT_TRUE(kept_run(file, {"key", 3}));
  EXPECT_FALSE(kept_run(file, {"key", 1}));
  EXPECT_FALSE(kept_run(file, {"other", 2}));
  for (const char* text : {"{ cut short", "[]", "{\"key\": \"key\"}"}) {
    write_file(file, text);
    EXPECT_FALSE(kept_run(file, {"key", 2})) << text;
  }
}

}  // namespace
}  // namespace psi_slam
