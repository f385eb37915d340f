// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "base/descriptor.h"

namespace psi_slam {

/// The write-ahead log of an SQLite database (https://sqlite.org/fileformat2.html#walformat): the pages that
/// were committed but are not yet in the database. Reads it without a lock, so that the program that writes
/// it never waits.
class WriteAheadLog {
 public:
  /// Two logs with equal identities hold the same pages.
  struct Identity {
    ino_t file = 0;
    std::array<char, 32> header{};
    std::size_t frames = 0;
    bool operator==(const Identity& other) const {
      return file == other.file && header == other.header && frames == other.frames;
    }
  };

  explicit WriteAheadLog(std::filesystem::path path) : path_(std::move(path)) {}

  /// Takes in what was committed since the last call. A missing file has no pages.
  void update();

  const Identity& identity() const { return identity_; }
  bool is_empty() const { return offsets_.empty(); }
  std::size_t page_bytes() const { return page_bytes_; }

  /// Reads bytes of a page at `offset` in it and returns true, or returns false if the page is not in the
  /// log. Pages count from 1.
  bool read_page(std::uint32_t page, std::uint64_t offset, char* bytes, std::size_t size) const;

 private:
  struct Sums {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    bool operator==(const Sums& other) const { return first == other.first && second == other.second; }
  };

  bool open();
  void begin(const std::array<char, 32>& header);
  void add_frames();
  Sums add(Sums sums, const char* bytes, std::size_t size) const;

  std::filesystem::path path_;
  Descriptor file_;
  Identity identity_;
  std::size_t page_bytes_ = 0;  // 0: the header is incomplete
  bool sums_big_endian_ = false;
  Sums sums_;                                       // checksums up to the last committed frame
  std::map<std::uint32_t, std::uint64_t> offsets_;  // of committed pages in the file
};

}  // namespace psi_slam
