// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/rawlog_archive.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>
#include <utility>

#include "base/forked_child.h"
#include "compression/compressed_file.h"
#include "psi_slam/user_error.h"
#include "rawlog/rawlog_stream.h"

namespace psi_slam {
namespace {

using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;
using Object = mrpt::serialization::CSerializable::Ptr;

constexpr std::size_t kMemoryOfChild_bytes = std::size_t{512} << 20;

/// Messages of the child. Some have values, in the form of MRPT's archives.
enum class Message : std::uint8_t {
  kReads,      ///< the child begins to read an object
  kObject,     ///< share of the file that has been read (double), and the object
  kEnd,        ///< share of the file that has been read (double)
  kUserError,  ///< text (std::string)
  kFailure     ///< text (std::string) of a SystemFailure
};

/// The child's end of the pipe, as a stream for MRPT's archives.
class MessageWriter {
 public:
  explicit MessageWriter(int descriptor) : descriptor_(descriptor) {}

  static std::size_t Read(void* /*bytes*/, std::size_t /*size*/) { return 0; }
  std::size_t Write(const void* bytes, std::size_t size) {
    waiting_.append(static_cast<const char*>(bytes), size);
    return size;
  }
  static std::string getStreamDescription() { return "pipe to the parent"; }

  /// Sends what was written. Ends the process if the parent no longer reads.
  void flush() {
    for (std::size_t sent = 0; sent < waiting_.size();) {
      const ssize_t count = ::write(descriptor_, waiting_.data() + sent, waiting_.size() - sent);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) ::_exit(1);
      sent += static_cast<std::size_t>(count);
    }
    waiting_.clear();
  }

 private:
  int descriptor_;
  std::string waiting_;
};

/// The parent's end of the pipe, as a stream for MRPT's archives.
class MessageReader {
 public:
  explicit MessageReader(Pipe& pipe) : pipe_(pipe) {}

  std::size_t Read(void* bytes, std::size_t size) {
    while (received_.size() - taken_ < size && !is_at_end_) is_at_end_ = !pipe_.read_to(received_);
    const std::size_t count = received_.copy(static_cast<char*>(bytes), size, taken_);
    taken_ += count;
    if (taken_ == received_.size()) received_.clear(), taken_ = 0;
    return count;
  }
  static std::size_t Write(const void* /*bytes*/, std::size_t /*size*/) { return 0; }
  static std::string getStreamDescription() { return "pipe from the child"; }

  /// Whether less was received than was to be read.
  bool is_at_end() const { return is_at_end_; }

 private:
  Pipe& pipe_;
  std::string received_;
  std::size_t taken_ = 0;
  bool is_at_end_ = false;
};

template <class Stream>
using Archive = mrpt::serialization::CArchiveStreamBase<Stream>;

bool is_used(const CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation) != nullptr;
}

/// Returns the object without the observations that psi-slam does not use; null if it is one of them.
Object used_part(const Object& object) {
  if (const auto* observation = dynamic_cast<const CObservation*>(object.get()))
    return is_used(*observation) ? object : nullptr;
  if (auto* frame = dynamic_cast<CSensoryFrame*>(object.get()))
    for (auto observation = frame->begin(); observation != frame->end();)
      observation =
          *observation && is_used(**observation) ? std::next(observation) : frame->erase(observation);
  return object;
}

/// Limits the memory of this process beyond what it has now. It leaves no memory dump if it crashes.
void limit_resources() {
  rlimit limit{};
  ::setrlimit(RLIMIT_CORE, &limit);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these reserve terabytes
  std::size_t pages = 0;
  if (!(std::ifstream("/proc/self/statm") >> pages)) return;
  limit.rlim_cur = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + kMemoryOfChild_bytes;
  limit.rlim_max = limit.rlim_cur;
  ::setrlimit(RLIMIT_AS, &limit);
#endif
}

void send_objects(const std::filesystem::path& path, MessageWriter& writer) {
  Archive<MessageWriter> archive(writer);
  const auto send = [&](Message message) -> mrpt::serialization::CArchive& {
    return archive << static_cast<std::uint8_t>(message);
  };
  try {
    RawlogStream objects(std::make_unique<CompressedFile>(path), false);
    while (true) {
      send(Message::kReads);
      writer.flush();
      const Object object = objects.next();
      if (!object) break;
      if (const Object used = used_part(object)) send(Message::kObject) << objects.progress() << *used;
    }
    send(Message::kEnd) << objects.progress();
  } catch (const std::bad_alloc&) {
    ::_exit(1);  // MRPT crashes if some of its allocations fail, so the parent reports both in the same way
  } catch (const UserError& error) {
    send(Message::kUserError) << std::string(error.what());
  } catch (const std::exception& error) {
    send(Message::kFailure) << std::string(error.what());
  }
  writer.flush();
}

/// The child process. Never returns to the code of the parent, and ends with SIGPIPE if the parent ends.
[[noreturn]] void read_in_child(const std::filesystem::path& path, int descriptor) {
  constexpr int kPipe = 3;
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C of a terminal is for the parent
  std::signal(SIGPIPE, SIG_DFL);
  ::dup2(descriptor, kPipe);
  ::close_range(kPipe + 1, ~0U, 0);  // pipes of the parent would not end before this process
  limit_resources();
  MessageWriter writer(kPipe);
  send_objects(path, writer);
  ::_exit(0);  // calls no destructors and flushes no stream buffers of the parent
}

pid_t start_child(const std::filesystem::path& path, Pipe& pipe) {
  register_rawlog_classes();
  const pid_t pid = ::fork();
  if (pid < 0)
    throw SystemFailure("cannot start a process that reads " + path.string() + ": " + std::strerror(errno));
  if (pid == 0) read_in_child(path, pipe.writing());
  pipe.close_writing();
  return pid;
}

}  // namespace

struct RawlogArchive::State {
  explicit State(std::filesystem::path rawlog) : path(std::move(rawlog)), child(start_child(path, pipe)) {}

  /// Receives the next object, or null at the end of the file. Throws the errors of the child, and an
  /// exception of MRPT if the child dies.
  Object receive();

  std::string place_of(std::uint64_t number) const {
    return path.string() + ": object " + std::to_string(number);
  }

  std::filesystem::path path;
  Pipe pipe;
  RunningChild child;
  MessageReader reader{pipe};
  Archive<MessageReader> archive{reader};
  std::uint64_t reads = 0;   ///< number of objects that the child has begun to read
  std::uint64_t object = 0;  ///< number of the object that next() last returned
  double progress = 0;
  bool is_at_end = false;
};

Object RawlogArchive::State::receive() {
  const auto text = [this] {
    std::string received;
    archive >> received;
    return received;
  };
  while (!is_at_end) {
    std::uint8_t message = 0;
    archive >> message;
    switch (static_cast<Message>(message)) {
      case Message::kReads:
        ++reads;
        break;
      case Message::kObject:
        object = reads;
        archive >> progress;
        return archive.ReadObject();
      case Message::kEnd:
        object = reads - 1;
        archive >> progress;
        is_at_end = true;
        break;
      case Message::kUserError:
        throw UserError(text());
      case Message::kFailure:
        throw SystemFailure(text());
    }
  }
  return nullptr;
}

RawlogArchive::RawlogArchive(const std::filesystem::path& path) : state_(std::make_unique<State>(path)) {}
RawlogArchive::~RawlogArchive() = default;

Object RawlogArchive::next() {
  try {
    return state_->receive();
  } catch (const std::exception&) {
    if (!state_->reader.is_at_end()) throw;
    report_death();
  }
}

void RawlogArchive::report_death() const {
  const int status = state_->child.wait().status;
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM))
    throw SystemFailure("the process that reads " + state_->path.string() + " was killed");
  throw UserError(state_->place_of(state_->reads) + " needs more than " +
                  std::to_string(kMemoryOfChild_bytes >> 20) +
                  " MiB of memory or crashes MRPT, so it is probably damaged. Fetch the log again");
}

std::string RawlogArchive::place() const {
  return state_->place_of(state_->object);
}

const std::filesystem::path& RawlogArchive::path() const {
  return state_->path;
}

double RawlogArchive::progress() const {
  return state_->progress;
}

}  // namespace psi_slam
