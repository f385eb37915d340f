// SPDX-License-Identifier: BSD-3-Clause
// The common part of ROS 1 bags and MCAP files: a sequence of records, most of them in chunks that may be
// compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/byte_cursor.h"
#include "base/compression/byte_source.h"
#include "base/compression/compressed_file.h"
#include "logs/rosbag/bag_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// The bytes of a bag that is still being recorded ended within a record.
class EndOfRecording : public UserError {
 public:
  using UserError::UserError;
};

/// Reads the bytes of a file in order. Its memory grows with the bytes that the file holds, never with a
/// length that the file merely states.
class BagStream {
 public:
  explicit BagStream(const std::filesystem::path& path)
      : bytes_of_bag_(std::make_unique<CompressedFile>(path)) {}
  /// Reads a bag that is still being recorded. read() and skip() throw EndOfRecording at its end.
  explicit BagStream(std::unique_ptr<ByteSource> recording)
      : bytes_of_bag_(std::move(recording)), is_growing_(true) {}

  /// Returns the next `size` bytes, valid until the next call. Throws UserError if the file has fewer bytes
  /// left, and MalformedBytes for a size that no record has.
  std::string_view read(std::uint64_t size);

  /// Skips the next `size` bytes, any number of them. Throws UserError if the file has fewer bytes left.
  void skip(std::uint64_t size);

  /// Returns up to `size` bytes, fewer only at the end of the file.
  std::string_view read_up_to(std::uint64_t size);

  std::uint64_t offset() const { return offset_; }
  double progress() const { return bytes_of_bag_->progress(); }
  const std::filesystem::path& path() const { return bytes_of_bag_->path(); }
  /// Returns whether the bag is still being recorded, so that it may end within a record.
  bool is_growing() const { return is_growing_; }

  /// Returns an offset as a place for error messages: "run.bag: byte 4117".
  std::string place_of(std::uint64_t offset) const;

 private:
  [[noreturn]] void fail_cut_off(std::uint64_t start, std::uint64_t expected) const;

  std::unique_ptr<ByteSource> bytes_of_bag_;
  bool is_growing_ = false;
  std::string bytes_;
  std::uint64_t offset_ = 0;
};

/// Returns the bytes of a plain file from `offset` to its end; a negative offset counts from the end. Empty
/// if there are no such bytes, or more than 256 MiB, which no summary of a bag needs.
std::string tail_of_file(const std::filesystem::path& path, std::int64_t offset);

/// A bag of records. Derived classes keep the current record and parse it.
class RecordBag : public BagFile {
 public:
  bool next(BagMessage& message) final;
  double progress() const override { return stream_.progress(); }
  std::string place() const override;

 protected:
  explicit RecordBag(BagStream stream) : stream_(std::move(stream)) {}

  /// Skips a message whose channel or connection is unknown, because the record that states it is damaged.
  /// Returns false. Throws DamagedPart for the first message of each.
  bool skip_unknown(std::uint32_t number, const std::string& kind);

  /// Reads the next record of the file; returns false at the end.
  virtual bool read_record_of_file() = 0;
  /// Reads the next record of the current chunk.
  virtual void read_record_of_chunk(ByteCursor& chunk) = 0;
  /// Takes the current record. Returns true if it is a wanted message, and then fills in `message`.
  virtual bool take_record(BagMessage& message) = 0;
  /// Throws UserError if the file ended before the end that it states.
  virtual void check_end() const {}

  /// Decompresses the bytes of a chunk to chunk_. `size` is the stated number of decompressed bytes. Throws
  /// MalformedBytes for damaged or nested chunks, and for chunks of another size.
  void unpack_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size);
  /// Makes next() continue with the records in chunk_.
  void begin_chunk() { in_chunk_.emplace(chunk_); }
  /// Reads all records up to the end or an error. Returns the first error, also of a damaged part.
  std::optional<UserError> read_to_end();

  BagStream stream_;
  std::string chunk_;
  std::uint64_t record_offset_ = 0;  // byte offset in the file of the current record or of its chunk

 private:
  std::optional<ByteCursor> in_chunk_;
  std::set<std::uint32_t> unknown_;    // numbers given to skip_unknown()
  bool has_record_ = false;            // whether the current record of the file was read as a whole
  bool is_chunk_ = false;              // whether that record is a chunk
  std::uint64_t offset_in_chunk_ = 0;  // byte offset of the current record in the decompressed chunk
};

}  // namespace psi_slam
