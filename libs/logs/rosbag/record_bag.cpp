// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/record_bag.h"

#include <algorithm>
#include <fstream>

#include "base/compression/compression.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 20;
constexpr std::int64_t kMaxTailBytes = std::int64_t{1} << 28;

}  // namespace

std::string_view BagStream::read_up_to(std::uint64_t size) {
  std::size_t have = 0;
  while (have < size) {
    const auto wanted =
        static_cast<std::size_t>(std::min(size - have, std::max<std::uint64_t>(kPieceBytes, have)));
    if (bytes_.size() < have + wanted) bytes_.resize(have + wanted);
    const std::size_t got = bytes_of_bag_->read(bytes_.data() + have, wanted);
    have += got;
    if (got == 0) break;
  }
  offset_ += have;
  return std::string_view(bytes_).substr(0, have);
}

std::string_view BagStream::read(std::uint64_t size) {
  check_stated_size(size);
  const std::uint64_t start = offset_;
  const std::string_view bytes = read_up_to(size);
  if (bytes.size() < size) fail_cut_off(start, size);
  return bytes;
}

void BagStream::skip(std::uint64_t size) {
  const std::uint64_t start = offset_;
  for (std::uint64_t left = size; left > 0;) {
    const std::size_t skipped = read_up_to(std::min(left, kPieceBytes)).size();
    if (skipped == 0) fail_cut_off(start, size);
    left -= skipped;
  }
}

void BagStream::fail_cut_off(std::uint64_t start, std::uint64_t expected) const {
  const std::string sentence = place_of(start) + ": the file is cut off, expected " +
                               std::to_string(expected) + " more bytes, found " +
                               std::to_string(offset_ - start) + ". Fetch the bag again";
  if (is_growing_) throw EndOfRecording(sentence);
  throw UserError(sentence);
}

std::string BagStream::place_of(std::uint64_t offset) const {
  return path().string() + ": byte " + std::to_string(offset);
}

std::string tail_of_file(const std::filesystem::path& path, std::int64_t offset) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::int64_t size = file ? static_cast<std::int64_t>(file.tellg()) : 0;
  const std::int64_t start = offset < 0 ? size + offset : offset;
  if (start < 0 || start >= size || size - start > kMaxTailBytes) return {};
  std::string bytes(static_cast<std::size_t>(size - start), '\0');
  file.seekg(start);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file ? bytes : std::string();
}

bool RecordBag::next(BagMessage& message) {
  try {
    while (true) {
      if (in_chunk_ && !in_chunk_->at_end()) {
        offset_in_chunk_ = in_chunk_->offset();
        read_record_of_chunk(*in_chunk_);
      } else {
        in_chunk_.reset();
        has_record_ = is_chunk_ = false;
        if (!read_record_of_file()) break;
        has_record_ = true;
      }
      if (take_record(message)) return true;
    }
  } catch (const MalformedBytes& error) {
    const std::string sentence = place() + (is_chunk_ ? ": a chunk of messages is lost, because " : ": ") +
                                 "the bag is damaged: " + error.what() + ". Fetch the bag again";
    in_chunk_.reset();
    if (has_record_) throw DamagedPart(sentence);
    throw UserError(sentence);
  } catch (const EndOfRecording&) {
    return false;
  }
  if (!stream_.is_growing()) check_end();
  return false;
}

bool RecordBag::skip_unknown(std::uint32_t number, const std::string& kind) {
  if (!unknown_.insert(number).second) return false;
  throw DamagedPart(place() + ": the bag is damaged: a message has no " + kind +
                    ", so its topic is unknown. Fetch the bag again");
}

void RecordBag::unpack_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size) {
  if (in_chunk_) throw MalformedBytes("a chunk contains another chunk");
  is_chunk_ = true;
  check_stated_size(size);
  const bool is_plain = compression.empty() || compression == "none";
  if (is_plain && bytes.size() != size)
    throw MalformedBytes("a chunk has " + std::to_string(bytes.size()) + " bytes, not the " +
                         std::to_string(size) + " that it states");
  chunk_ = is_plain ? std::string(bytes) : decompress(compression, bytes, size);
}

std::optional<UserError> RecordBag::read_to_end() {
  std::optional<UserError> first;
  while (true) {
    try {
      for (BagMessage message; next(message);) continue;
      return first;
    } catch (const DamagedPart& error) {
      if (!first) first = error;
    } catch (const UserError& error) {
      return first ? first : error;
    }
  }
}

std::string RecordBag::place() const {
  std::string place = stream_.place_of(record_offset_);
  if (in_chunk_) place += ", byte " + std::to_string(offset_in_chunk_) + " of the chunk";
  return place;
}

}  // namespace psi_slam
