// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/bag_folder.h"

#include <mrpt/containers/yaml.h>

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>

#include "psi_slam/base/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

bool is_bag_file(const fs::path& path) {
  return path.extension() == ".db3" || path.extension() == ".mcap";
}

/// "run_2.db3" comes before "run_10.db3".
bool by_numbers(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& path) {
    const std::string stem = path.stem().string();
    const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
    const std::string number = stem.substr(digits);
    return std::make_tuple(stem.substr(0, digits), number.size(), number);
  };
  return key(a) < key(b);
}

std::vector<fs::path> files_listed(const fs::path& metadata) {
  std::vector<fs::path> files;
  try {
    const auto yaml = mrpt::containers::yaml::FromFile(metadata.string());
    for (const auto& file : yaml["rosbag2_bagfile_information"]["relative_file_paths"].asSequence()) {
      const fs::path name = file.as<std::string>();
      // The first versions of rosbag2 wrote the paths with the folder's own name in front.
      const fs::path beside = metadata.parent_path() / name;
      files.push_back(fs::exists(beside) ? beside : metadata.parent_path() / name.filename());
    }
  } catch (const std::exception&) {
    throw UserError(metadata.string() +
                    " is damaged, expected rosbag2_bagfile_information with relative_file_paths");
  }
  return files;
}

}  // namespace

std::vector<fs::path> files_of_bag_folder(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / "metadata.yaml", ignored)) return files_listed(folder / "metadata.yaml");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (is_bag_file(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end(), by_numbers);
  return files;
}

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
