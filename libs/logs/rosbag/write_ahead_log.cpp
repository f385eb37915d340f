// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/write_ahead_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>

namespace psi_slam {
namespace {

constexpr std::size_t kHeaderBytes = 32;
constexpr std::size_t kFrameHeaderBytes = 24;
constexpr std::uint32_t kWalMagic = 0x377F0682;  // the last bit states the byte order of the checksums
constexpr std::size_t kFewestPageBytes = 512;
constexpr std::size_t kMostPageBytes = 65536;

std::uint32_t number_at(const char* bytes, bool big_endian = true) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < 4; ++i)
    number |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * (big_endian ? 3 - i : i));
  return number;
}

bool read_whole(const Descriptor& file, std::uint64_t offset, char* bytes, std::size_t size) {
  return ::pread(file.number(), bytes, size, static_cast<off_t>(offset)) == static_cast<ssize_t>(size);
}

}  // namespace

void WriteAheadLog::update() {
  std::array<char, kHeaderBytes> header{};
  if (!open() || !read_whole(file_, 0, header.data(), header.size())) {
    begin({});
    return;
  }
  if (header != identity_.header) begin(header);
  if (page_bytes_ > 0) add_frames();
}

/// Opens the file, unless it is open. Returns false if it does not exist.
bool WriteAheadLog::open() {
  struct stat state = {};
  if (::stat(path_.c_str(), &state) != 0) {
    file_.close();
    identity_.file = 0;
    return false;
  }
  if (file_.is_open() && state.st_ino == identity_.file) return true;
  file_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file_.is_open() || ::fstat(file_.number(), &state) != 0) return false;
  begin({});
  identity_.file = state.st_ino;
  return true;
}

/// Forgets all pages and begins a log with this header.
void WriteAheadLog::begin(const std::array<char, 32>& header) {
  identity_.header = header;
  identity_.frames = 0;
  offsets_.clear();
  page_bytes_ = 0;
  const std::uint32_t magic = number_at(header.data());
  if ((magic & ~1U) != kWalMagic) return;
  sums_big_endian_ = (magic & 1U) != 0;
  sums_ = add({}, header.data(), kFrameHeaderBytes);
  const std::size_t page_bytes = number_at(&header[8]);
  const bool is_whole = sums_ == Sums{number_at(&header[24]), number_at(&header[28])};
  if (is_whole && page_bytes >= kFewestPageBytes && page_bytes <= kMostPageBytes) page_bytes_ = page_bytes;
}

/// Reads frames up to the last commit. A frame that the writer has not completed has a wrong checksum; one
/// that remains of an earlier log has another salt.
void WriteAheadLog::add_frames() {
  const std::size_t frame_bytes = kFrameHeaderBytes + page_bytes_;
  std::string frame(frame_bytes, '\0');
  std::map<std::uint32_t, std::uint64_t> uncommitted;
  Sums sums = sums_;
  for (std::size_t number = identity_.frames;; ++number) {
    const std::uint64_t offset = kHeaderBytes + std::uint64_t{number} * frame_bytes;
    if (!read_whole(file_, offset, frame.data(), frame_bytes)) return;
    if (frame.compare(8, 8, identity_.header.data() + 16, 8) != 0) return;
    sums = add(add(sums, frame.data(), 8), &frame[kFrameHeaderBytes], page_bytes_);
    if (!(sums == Sums{number_at(&frame[16]), number_at(&frame[20])})) return;
    uncommitted[number_at(frame.data())] = offset + kFrameHeaderBytes;
    const bool is_commit = number_at(&frame[4]) != 0;
    if (!is_commit) continue;
    for (const auto& [page, place] : uncommitted) offsets_[page] = place;
    uncommitted.clear();
    sums_ = sums;
    identity_.frames = number + 1;
  }
}

WriteAheadLog::Sums WriteAheadLog::add(Sums sums, const char* bytes, std::size_t size) const {
  for (std::size_t i = 0; i + 8 <= size; i += 8) {
    sums.first += number_at(bytes + i, sums_big_endian_) + sums.second;
    sums.second += number_at(bytes + i + 4, sums_big_endian_) + sums.first;
  }
  return sums;
}

bool WriteAheadLog::read_page(std::uint32_t page, std::uint64_t offset, char* bytes, std::size_t size) const {
  const auto found = offsets_.find(page);
  return found != offsets_.end() && read_whole(file_, found->second + offset, bytes, size);
}

}  // namespace psi_slam
