// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/bag_folder.h"

#include <algorithm>
#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace fs = std::filesystem;

BagFolder::BagFolder(std::vector<fs::path> files)
    : files_(std::move(files)), file_(open_bag(files_.front())) {}

std::vector<BagTopic> BagFolder::topics() {
  std::vector<BagTopic> all;
  for (const fs::path& path : files_) {
    try {
      for (BagTopic& topic : open_bag(path)->topics())
        if (std::find(all.begin(), all.end(), topic) == all.end()) all.push_back(std::move(topic));
    } catch (const UserError&) {
      if (path == files_.front()) throw;  // of a later one, reading will say what is wrong
    }
  }
  return all;
}

void BagFolder::want(const std::vector<std::string>& topics) {
  BagFile::want(topics);
  file_->want(topics);
}

bool BagFolder::next(BagMessage& message) {
  while (!file_->next(message)) {
    if (at_ + 1 == files_.size()) return false;
    file_ = open_bag(files_[++at_]);
    file_->want(wanted());
  }
  return true;
}

double BagFolder::progress() const {
  return (static_cast<double>(at_) + file_->progress()) / static_cast<double>(files_.size());
}

}  // namespace psi_slam
