// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/sparse_logs.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class SparseLogFolder : public testing::Test {
 protected:
  SparseLogFolder() {
    for (const fs::path& folder : {data_ / "sparse", ini_}) fs::create_directories(folder);
    for (const char* log : {"office.log", "hall.log", "sparse/yard.log"}) add(log);
    write_file(ini_ / "office.ini", "[log]\n");
  }

  void add(const std::string& log) const {
    write_file(data_ / log, "");
    write_file(fs::path(data_ / log).replace_extension(".relations"), "");
  }

  std::string refusal(const std::vector<std::string>& names) const {
    try {
      find_sparse_logs(data_, ini_, names);
      return "nothing was thrown";
    } catch (const UserError& error) {
      return error.what();
    }
  }

  static std::vector<std::string> names_of(const std::vector<BenchmarkLog>& logs) {
    std::vector<std::string> names;
    for (const BenchmarkLog& log : logs) names.push_back(log.name);
    return names;
  }

  TemporaryFolder folder_;
  fs::path data_ = folder_.path() / "data";
  fs::path ini_ = folder_.path() / "ini";
};

TEST_F(SparseLogFolder, logs_with_settings_are_dense_and_all_others_sparse) {
  const SparseLogs logs = find_sparse_logs(data_, ini_);
  EXPECT_THAT(names_of(logs.dense), ElementsAre("office"));
  EXPECT_THAT(names_of(logs.sparse), ElementsAre("hall", "yard"));
  EXPECT_EQ(logs.dense[0].ini, ini_ / "office.ini");
  EXPECT_EQ(logs.sparse[0].ini, "") << "the defaults";
  EXPECT_EQ(logs.sparse[1].log, data_ / "sparse" / "yard.log");
}

TEST_F(SparseLogFolder, logs_in_the_folder_sparse_are_sparse_with_their_settings) {
  write_file(ini_ / "yard.ini", "[log]\n");
  const SparseLogs logs = find_sparse_logs(data_, ini_);
  EXPECT_THAT(names_of(logs.sparse), ElementsAre("hall", "yard"));
  EXPECT_EQ(logs.sparse[1].ini, ini_ / "yard.ini");
}

TEST_F(SparseLogFolder, names_choose_logs) {
  const SparseLogs logs = find_sparse_logs(data_, ini_, {"yard"});
  EXPECT_TRUE(logs.dense.empty());
  EXPECT_THAT(names_of(logs.sparse), ElementsAre("yard"));
  EXPECT_THAT(refusal({"yard", "moon"}), HasSubstr("there is no log called moon"));
}

TEST_F(SparseLogFolder, logs_without_relations_are_left_out) {
  fs::remove(data_ / "hall.relations");
  EXPECT_THAT(find_sparse_logs(data_, ini_).without_relations, ElementsAre("hall"));
  EXPECT_THAT(refusal({"hall"}), HasSubstr("expected hall.relations beside it"));
  fs::remove(data_ / "office.relations");
  fs::remove(data_ / "sparse" / "yard.relations");
  EXPECT_THAT(refusal({}), HasSubstr("no log can be evaluated"));
}

TEST_F(SparseLogFolder, must_exist) {
  EXPECT_THROW(find_sparse_logs(folder_.path() / "none", ini_), UserError);
}

}  // namespace
}  // namespace psi_slam
