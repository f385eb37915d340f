// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rosbag/bag_file.h"

namespace psi_slam {

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
