// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/bag_stream.h"

#include <algorithm>
#include <fstream>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 20;
constexpr std::int64_t kMostOfTail = std::int64_t{1} << 28;

}  // namespace

std::string_view BagStream::read_up_to(std::uint64_t size) {
  std::size_t have = 0;
  while (have < size) {
    const auto wanted =
        static_cast<std::size_t>(std::min(size - have, std::max<std::uint64_t>(kPieceBytes, have)));
    if (bytes_.size() < have + wanted) bytes_.resize(have + wanted);
    const std::size_t got = file_.read(bytes_.data() + have, wanted);
    have += got;
    if (got == 0) break;
  }
  offset_ += have;
  return std::string_view(bytes_).substr(0, have);
}

std::string_view BagStream::read(std::uint64_t size) {
  const std::uint64_t start = offset_;
  const std::string_view bytes = read_up_to(size);
  if (bytes.size() < size)
    throw UserError(place_of(start) + ": the file is cut off: " + std::to_string(size) +
                    " bytes are announced but " + std::to_string(bytes.size()) + " are left");
  return bytes;
}

void BagStream::skip(std::uint64_t size) {
  for (std::uint64_t left = size; left > 0;) left -= read(std::min(left, kPieceBytes)).size();
}

std::string BagStream::place_of(std::uint64_t offset) const {
  return path().string() + ": byte " + std::to_string(offset);
}

std::optional<std::string> tail_of_file(const std::filesystem::path& path, std::int64_t offset) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::int64_t size = file ? static_cast<std::int64_t>(file.tellg()) : 0;
  const std::int64_t start = offset < 0 ? size + offset : offset;
  if (start < 0 || start >= size || size - start > kMostOfTail) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(size - start), '\0');
  file.seekg(start);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file) return std::nullopt;
  return bytes;
}

}  // namespace psi_slam
