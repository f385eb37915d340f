// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "psi_slam/logs/bag_file.h"

namespace psi_slam {

/// The files of a ROS 2 bag's folder in their order: what its metadata.yaml lists or, where the recorder was
/// killed before it wrote one, its .db3 and .mcap files by the numbers in their names. Empty when the folder
/// has neither.
std::vector<std::filesystem::path> files_of_bag_folder(const std::filesystem::path& folder);

/// Several files of one bag, read one behind the other.
class BagFolder : public BagFile {
 public:
  explicit BagFolder(std::vector<std::filesystem::path> files);

  std::vector<BagTopic> topics() override;
  void want(const std::vector<std::string>& topics) override;
  bool next(BagMessage& message) override;
  double progress() const override;
  std::string place() const override { return file_->place(); }

 private:
  std::vector<std::filesystem::path> files_;
  std::size_t at_ = 0;  // of files_
  std::unique_ptr<BagFile> file_;
};

}  // namespace psi_slam
