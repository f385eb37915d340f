// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rawlog/rawlog_stream.h"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>

#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Stream for mrpt::serialization::archiveFrom(). Reads one byte ahead, to distinguish an end of file between
/// objects from one within an object.
class ArchiveStream {
 public:
  explicit ArchiveStream(std::unique_ptr<ByteSource> file) : file_(std::move(file)) {}

  bool is_at_end() {
    if (!ahead_) {
      char byte = 0;
      if (read_file(&byte, 1) == 1) ahead_ = byte;
    }
    return !ahead_;
  }

  std::size_t Read(void* bytes, std::size_t size) {
    if (size == 0 || is_at_end()) {
      ended_early_ = size > 0;
      return 0;
    }
    auto* target = static_cast<char*>(bytes);
    *target = *ahead_;
    ahead_.reset();
    const std::size_t got = 1 + read_file(target + 1, size - 1);
    ended_early_ = got < size;
    return ended_early_ ? 0 : got;  // MRPT would take the first bytes of a number for a number
  }

  static std::size_t Write(const void*, std::size_t) { return 0; }
  std::string getStreamDescription() const { return file_->path().string(); }

  const ByteSource& file() const { return *file_; }
  bool ended_early() const { return ended_early_; }

  /// Reason why decompression failed. The stream keeps it, because MRPT wraps exceptions.
  const std::optional<UserError>& failure() const { return failure_; }

 private:
  std::size_t read_file(char* bytes, std::size_t size) {
    try {
      std::size_t done = 0;
      while (done < size) {
        const std::size_t got = file_->read(bytes + done, size - done);
        if (got == 0) break;
        done += got;
      }
      return done;
    } catch (const UserError& error) {
      failure_ = error;
      throw;
    }
  }

  std::unique_ptr<ByteSource> file_;
  std::optional<char> ahead_;
  std::optional<UserError> failure_;
  bool ended_early_ = false;
};

}  // namespace

struct RawlogStream::State {
  State(std::unique_ptr<ByteSource> bytes, bool growing)
      : stream(std::move(bytes)), archive(stream), is_growing(growing) {
    register_rawlog_classes();
  }

  ArchiveStream stream;
  mrpt::serialization::CArchiveStreamBase<ArchiveStream> archive;
  bool is_growing;
  std::size_t objects = 0;
};

void register_rawlog_classes() {
  static const bool kRegistered = [] {
    mrpt::obs::registerAllClasses_mrpt_obs();
    mrpt::maps::registerAllClasses_mrpt_maps();
    return true;
  }();
  static_cast<void>(kRegistered);
}

RawlogStream::RawlogStream(std::unique_ptr<ByteSource> bytes, bool is_growing)
    : state_(std::make_unique<State>(std::move(bytes), is_growing)) {}

RawlogStream::~RawlogStream() = default;

mrpt::serialization::CSerializable::Ptr RawlogStream::next() {
  ArchiveStream& stream = state_->stream;
  if (stream.is_at_end()) return nullptr;
  ++state_->objects;
  try {
    return state_->archive.ReadObject();
  } catch (const std::bad_alloc&) {
    if (!state_->is_growing) throw;
    throw UserError(place() +
                    " needs more memory than there is, so it is probably damaged. Fetch the log again");
  } catch (const std::exception&) {
    if (stream.failure()) throw UserError(*stream.failure());
    if (stream.ended_early() && state_->is_growing) return nullptr;
    if (stream.ended_early())
      throw UserError(place() + ": the file ends within this object. Fetch the log again");
    throw UserError(place() +
                    " is damaged or has a class that this version of MRPT does not know, expected an "
                    "action, a sensory frame or an observation");
  }
}

std::string RawlogStream::place() const {
  return path().string() + ": object " + std::to_string(state_->objects);
}

const std::filesystem::path& RawlogStream::path() const {
  return state_->stream.file().path();
}

double RawlogStream::progress() const {
  return state_->stream.file().progress();
}

}  // namespace psi_slam
