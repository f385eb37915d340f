// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/foreign_file.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace psi_slam {
namespace {

/// A file format that is recognised by a text at an offset.
struct Kind {
  static constexpr std::size_t kAnywhere = std::string_view::npos;
  std::size_t at = 0;
  std::string_view text;
  std::string_view sentences;
};

constexpr std::string_view kArchive = "It is an archive. Unpack it and name the log in it";
constexpr std::string_view kImage = "It is an image. Name the log that the map was made from";
constexpr std::string_view kConvertible =
    "It looks like a table or a JSON log of scans. Convert it with share/scripts/carmen-from-text.py";

// The first kind that fits counts.
constexpr std::array kKinds{
    Kind{0, "PK\x03\x04", kArchive},
    Kind{0, "7z\xBC\xAF", kArchive},
    Kind{0, "Rar!", kArchive},
    Kind{257, "ustar", kArchive},
    Kind{0, "#ROSBAG V1",
         "It is a ROS bag of version 1, such as 1.2, expected 2.0. Convert it with ROS 1: rosbag filter "
         "OLD.bag NEW.bag True"},
    Kind{0, "psi-slam session", "It is a session of psi-slam. Continue it with --resume"},
    Kind{0, "version https://git-lfs", "It is a pointer of Git LFS. Fetch the file with: git lfs pull"},
    Kind{0, "<", "It looks like a web page. Download the log again"},
    Kind{0, "\x89PNG", kImage},
    Kind{0, "P5", kImage},
    Kind{0, "\xD4\xC3\xB2\xA1",
         "It holds network packets. Convert them to a ROS bag with the lidar's driver"},
    Kind{Kind::kAnywhere, "VERTEX", "It looks like a pose graph, which has no scans. Name a log"},
    Kind{Kind::kAnywhere, "\"readings\"", kConvertible},
    Kind{Kind::kAnywhere, "angle_min:",
         "It is text of rostopic echo. Record a bag, or use rostopic echo -p and convert the table with "
         "share/scripts/carmen-from-text.py"},
};

/// Returns whether the last complete line, or the only one, has at least ten commas or semicolons.
bool is_table(std::string_view head) {
  const std::size_t end = head.rfind('\n');
  const std::string_view lines = head.substr(0, end);
  const std::string_view line = lines.substr(lines.rfind('\n') + 1);
  const auto is_separator = [](char c) { return c == ',' || c == ';'; };
  return std::count_if(line.begin(), line.end(), is_separator) >= 10;
}

}  // namespace

std::string likely_content(std::string_view head) {
  for (const Kind& kind : kKinds) {
    const std::size_t found = kind.at == Kind::kAnywhere ? head.find(kind.text) : kind.at;
    if (found < head.size() && head.substr(found, kind.text.size()) == kind.text)
      return std::string(kind.sentences);
  }
  const bool is_text = head.find('\0') == std::string_view::npos;
  return std::string(is_text && is_table(head) ? kConvertible : "Convert it first");
}

}  // namespace psi_slam
