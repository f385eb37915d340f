// SPDX-License-Identifier: BSD-3-Clause
#include "base/yaml_directives.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

bool found_in(const std::string& text) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "map.yaml";
  write_file(path, text);
  return has_yaml_directive(path);
}

TEST(YamlDirectives, are_lines_that_begin_with_a_percent_sign) {
  EXPECT_TRUE(found_in("%YAML 1.2\n---\nimage: map.pgm\n"));
  EXPECT_TRUE(found_in("image: map.pgm\n%TAG"));
  EXPECT_TRUE(found_in("image: map.pgm\r%\r"));
}

TEST(YamlDirectives, are_not_percent_signs_within_lines) {
  EXPECT_FALSE(found_in(""));
  EXPECT_FALSE(found_in("image: 50%.pgm\n %YAML\n"));
}

TEST(YamlDirectives, a_line_of_more_than_65536_bytes_counts_as_one) {
  const std::string longest(65'536, 'a');
  EXPECT_FALSE(found_in(longest + '\n' + longest));
  EXPECT_TRUE(found_in('\n' + longest + 'a'));
}

TEST(YamlDirectives, an_unreadable_file_has_none) {
  const TemporaryFolder folder;
  EXPECT_FALSE(has_yaml_directive(folder.path() / "missing.yaml"));
}

}  // namespace
}  // namespace psi_slam
