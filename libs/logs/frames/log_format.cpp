// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/log_format.h"

#include <mrpt/containers/yaml.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string>
#include <system_error>
#include <tuple>

#include "base/byte_cursor.h"
#include "base/compression/compressed_file.h"
#include "base/text_parts.h"
#include "base/yaml_directives.h"
#include "logs/frames/foreign_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExpected =
    ", expected a CARMEN log or an MRPT .rawlog, plain or compressed, or a ROS bag (.bag, .db3, .mcap, or "
    "the folder of a ROS 2 bag)";
constexpr std::size_t kHeadBytes = std::size_t{256} * 1024;

/// Returns whether the bytes start like an MRPT archive, which begins with an object. The first byte holds
/// the length of the class name, with the highest bit set. The class name follows.
bool is_mrpt_archive(std::string_view head) {
  if (head.empty()) return false;
  const auto first = static_cast<unsigned char>(head[0]);
  const std::string_view name = head.substr(1, first & 0x7FU);
  if ((first & 0x80U) == 0 || name.size() < 2) return false;
  const bool is_class = name[0] == 'C' || starts_with(name, "mrpt::");
  return is_class && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                  c == ':';
         });
}

/// Returns whether the text has a line that starts with the name of a CARMEN message.
bool is_carmen(std::string_view head) {
  constexpr std::array<std::string_view, 7> kBeginnings{"FLASER", "RLASER", "RAWLASER", "ROBOTLASER",
                                                        "PARAM",  "ODOM",   "TRUEPOS"};
  if (head.find('\0') != std::string_view::npos) return false;
  while (!head.empty()) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    const std::string_view line = head.substr(0, end);
    const std::size_t space = line.find_first_of(" \t");
    if (space != std::string_view::npos)
      for (const std::string_view beginning : kBeginnings)
        if (starts_with(line.substr(0, space), beginning)) return true;
    head.remove_prefix(std::min(end + 1, head.size()));
  }
  return false;
}

/// Returns the file that metadata.yaml of a folder lists under `name`. rosbag2 lists compressed files, which
/// the user may have unpacked. The unpacked file takes precedence, because a recorder that was killed leaves
/// an incomplete compressed file beside it.
fs::path listed_file(const fs::path& folder, const fs::path& name) {
  // Early versions of rosbag2 wrote paths that start with the name of the folder itself.
  for (const fs::path& path : {folder / name, folder / name.filename()})
    for (const char* ending : {"", ".zstd", ".zst"}) {
      fs::path file = without_zstd(path);
      file += ending;
      if (fs::exists(file)) return file;
    }
  return folder / name.filename();
}

std::vector<fs::path> files_listed(const fs::path& metadata) {
  std::vector<fs::path> files;
  try {
    if (has_yaml_directive(metadata)) throw MalformedBytes("a directive");
    const auto yaml = mrpt::containers::yaml::FromFile(metadata.string());
    const auto paths = yaml["rosbag2_bagfile_information"]["relative_file_paths"];
    for (const auto& listed : paths.asSequence()) {
      const auto name = listed.as<std::string>();
      if (name.find('\0') != std::string::npos) throw MalformedBytes("a name with a byte 0");
      files.push_back(listed_file(metadata.parent_path(), name));
      if (fs::is_directory(files.back())) throw MalformedBytes("a folder");  // it could list itself
    }
  } catch (const std::exception&) {
    throw UserError(
        metadata.string() +
        " is damaged, expected rosbag2_bagfile_information with relative_file_paths. Fetch it again, or "
        "delete it to read the bag files by their names");
  }
  return files;
}

}  // namespace

std::string_view name_of(LogFormat format) {
  constexpr std::array<std::string_view, 6> kNames{
      "CARMEN", "MRPT rawlog", "ROS 1 bag", "ROS 2 bag (SQLite)", "ROS 2 bag (MCAP)", "ROS 2 bag (folder)"};
  return kNames.at(static_cast<std::size_t>(format));
}

bool is_bag(LogFormat format) {
  return format != LogFormat::kCarmen && format != LogFormat::kMrptRawlog;
}

fs::path without_zstd(fs::path path) {
  if (path.extension() == ".zstd" || path.extension() == ".zst") path.replace_extension();
  return path;
}

bool is_earlier_bag_file(const fs::path& a, const fs::path& b) {
  const auto key = [](const fs::path& path) {
    const fs::path unpacked = without_zstd(path);
    const std::string stem = unpacked.stem().string();
    const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
    const std::string number = stem.substr(digits);
    return std::make_tuple(stem.substr(0, digits), number.size(), number, unpacked.extension().string());
  };
  return key(a) < key(b);
}

std::vector<fs::path> files_of_bag_folder(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / "metadata.yaml", ignored)) return files_listed(folder / "metadata.yaml");
  return numbered_bag_files(folder);
}

std::vector<fs::path> numbered_bag_files(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path unpacked = without_zstd(entry.path());
    const bool is_bag_file = unpacked.extension() == ".db3" || unpacked.extension() == ".mcap";
    if (is_bag_file && (entry.path() == unpacked || !fs::exists(unpacked))) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end(), is_earlier_bag_file);
  return files;
}

LogFormat detect_log_format(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw UserError(path.string() + " does not exist, expected a log. Check the path");
  if (fs::is_directory(path, ignored)) {
    if (!files_of_bag_folder(path).empty()) return LogFormat::kRos2Folder;
    throw UserError(path.string() + " is a folder" + kExpected + ". Name a log file");
  }
  CompressedFile file(path);
  std::string head(kHeadBytes, '\0');
  head.resize(file.read(head.data(), head.size()));
  if (head.empty()) throw UserError(path.string() + " is empty" + kExpected + ". Fetch or record it again");
  if (starts_with(head, "#ROSBAG V2")) return LogFormat::kRos1Bag;
  if (starts_with(head, "\x89MCAP")) return LogFormat::kRos2Mcap;
  if (starts_with(head, std::string_view("SQLite format 3\0", 16))) return LogFormat::kRos2Sqlite;
  if (is_mrpt_archive(head)) return LogFormat::kMrptRawlog;
  if (is_carmen(head)) return LogFormat::kCarmen;
  throw UserError(path.string() + " has an unknown format" + kExpected + ". " + likely_content(head));
}

}  // namespace psi_slam
