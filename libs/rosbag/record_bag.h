// SPDX-License-Identifier: BSD-3-Clause
// What ROS 1 bags and MCAP files have in common: a sequence of records, most of them in chunks that may be
// compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/byte_cursor.h"
#include "compression/compressed_file.h"
#include "rosbag/bag_file.h"

namespace psi_slam {

/// Reads the bytes of a file in order. Memory grows with the bytes that the file holds, never with a length
/// that it merely states.
class BagStream {
 public:
  explicit BagStream(const std::filesystem::path& path) : file_(path) {}

  /// Returns the next `size` bytes, valid until the next call. Throws UserError if the file ends before.
  std::string_view read(std::uint64_t size);

  /// Returns up to `size` bytes, fewer only at the end of the file.
  std::string_view read_up_to(std::uint64_t size);

  std::uint64_t offset() const { return offset_; }
  double progress() const { return file_.progress(); }
  const std::filesystem::path& path() const { return file_.path(); }

  /// "run.bag: byte 4117".
  std::string place_of(std::uint64_t offset) const;

 private:
  CompressedFile file_;
  std::string bytes_;
  std::uint64_t offset_ = 0;
};

/// Returns the bytes of a plain file from `offset` to its end; a negative offset counts from the end. Empty
/// if there are none, or more than the summary of a bag can have.
std::string tail_of_file(const std::filesystem::path& path, std::int64_t offset);

/// A bag of records. Derived classes keep the current record and parse it.
class RecordBag : public BagFile {
 public:
  bool next(BagMessage& message) final;
  double progress() const override { return stream_.progress(); }
  std::string place() const override;

 protected:
  explicit RecordBag(const std::filesystem::path& path) : stream_(path) {}

  /// Reads the next record of the file; returns false at the end.
  virtual bool read_record_of_file() = 0;
  virtual void read_record_of_chunk(ByteCursor& chunk) = 0;
  /// Returns true if the record is a wanted message, which it fills in.
  virtual bool take_record(BagMessage& message) = 0;
  /// Throws UserError if the file ended too early.
  virtual void check_end() const {}

  /// Sets the decompressed bytes of a chunk.
  void unpack_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size);
  void begin_chunk() { in_chunk_.emplace(chunk_); }
  /// Reads all records, up to the first error.
  void read_to_end();

  BagStream stream_;
  std::string chunk_;
  std::uint64_t record_offset_ = 0;  // in the file, of the record or its chunk

 private:
  std::optional<ByteCursor> in_chunk_;
  std::uint64_t offset_in_chunk_ = 0;  // of the record
};

}  // namespace psi_slam
