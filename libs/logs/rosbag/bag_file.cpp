// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/bag_file.h"

#include <utility>

#include "logs/frames/log_format.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// Several files of one bag, read one after the other.
class BagFolder : public BagFile {
 public:
  explicit BagFolder(std::vector<fs::path> files)
      : files_(std::move(files)), file_(open_bag(files_.front())) {}

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> all;
    for (const fs::path& path : files_) {
      try {
        for (const BagTopic& topic : open_bag(path)->topics()) add_topic(all, topic);
      } catch (const UserError&) {
        if (path == files_.front()) throw;  // errors of later files are reported when they are read
      }
    }
    return all;
  }

  void want(const std::vector<std::string>& topics) override {
    BagFile::want(topics);
    file_->want(topics);
  }

  bool next(BagMessage& message) override {
    while (!file_->next(message)) {
      if (current_ + 1 == files_.size()) return false;
      file_ = open_bag(files_[++current_]);
      file_->want(wanted());
    }
    return true;
  }

  double progress() const override {
    return (static_cast<double>(current_) + file_->progress()) / static_cast<double>(files_.size());
  }

  std::string place() const override { return file_->place(); }

 private:
  std::vector<fs::path> files_;
  std::size_t current_ = 0;  // index of the current file in files_
  std::unique_ptr<BagFile> file_;
};

}  // namespace

std::string ros1_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  std::string name(type);
  if (const std::size_t middle = name.find(kMiddle); middle != std::string::npos)
    name.replace(middle, kMiddle.size(), "/");
  return name;
}

std::string ros2_type_name(std::string_view type) {
  std::string name = ros1_type_name(type);
  if (const std::size_t slash = name.find('/'); slash != std::string::npos) name.insert(slash, "/msg");
  return name;
}

void add_topic(std::vector<BagTopic>& topics, const BagTopic& topic) {
  if (std::find(topics.begin(), topics.end(), topic) == topics.end()) topics.push_back(topic);
}

void check_stated_size(std::uint64_t bytes) {
  if (bytes > kMaxRecordBytes)
    throw MalformedBytes("it states a size of " + std::to_string(bytes) + " bytes, expected at most " +
                         std::to_string(kMaxRecordBytes));
}

std::string damage_text(const BagFile& bag, const BagMessage& message, const MalformedBytes& damage) {
  return bag.place() + ": the message on " + message.topic->name + " is damaged: " + damage.what() +
         ". Record the bag again";
}

std::unique_ptr<BagFile> open_bag(const fs::path& path) {
  switch (detect_log_format(path)) {
    case LogFormat::kRos1Bag:
      return open_ros1_bag(path);
    case LogFormat::kRos2Sqlite:
      return open_sqlite_bag(path);
    case LogFormat::kRos2Mcap:
      return open_mcap_bag(path);
    case LogFormat::kRos2Folder:
      return std::make_unique<BagFolder>(files_of_bag_folder(path));
    default:
      throw UserError(path.string() +
                      " is not a ROS bag, expected a .bag, .db3 or .mcap file. Choose another file");
  }
}

}  // namespace psi_slam
