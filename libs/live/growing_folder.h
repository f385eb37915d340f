// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "logs/rosbag/bag_recorder.h"

namespace psi_slam {

/// Returns whether rosbag2 has closed a bag: it writes metadata.yaml at the end, with a list of files.
/// `file`: a file that must be in the list; empty: any.
bool is_closed_bag(const std::filesystem::path& folder, const std::filesystem::path& file = {});

/// The folder of a ROS 2 bag that rosbag2 is still recording. Its files (.db3, .mcap) are read one after the
/// other, in the order of the numbers in their names, as they appear. rosbag2 begins the next file only after
/// it has written all messages of the last one. A file that it has already compressed (.db3.zstd) is read as
/// a whole. The bag ends when the recorder has closed it, or when `recorder` stops the reader. topics() and
/// progress() must not be called.
class GrowingFolder : public BagFile {
 public:
  GrowingFolder(std::filesystem::path folder, BagRecorder recorder);

  std::vector<BagTopic> topics() override { return {}; }
  void want(const std::vector<std::string>& topics) override;
  bool next(BagMessage& message) override;
  double progress() const override { return 0; }
  std::string place() const override { return file_ ? file_->place() : folder_.string(); }

 private:
  std::optional<std::filesystem::path> next_file() const;
  bool open_next();
  std::unique_ptr<BagFile> open(const std::filesystem::path& file);

  std::filesystem::path folder_;
  BagRecorder recorder_;
  bool ended_ = false;          // the user stopped, or waits no longer
  std::filesystem::path last_;  // file that was opened last; empty: none
  std::unique_ptr<BagFile> file_;
};

}  // namespace psi_slam
