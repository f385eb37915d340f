// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rawlog/rawlog_archive.h"

#include <fcntl.h>
#include <mrpt/io/lazy_load_path.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "base/compression/compressed_file.h"
#include "base/forked_child.h"
#include "logs/observations/cloud_points.h"
#include "logs/rawlog/rawlog_stream.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CSensoryFrame;
using Object = mrpt::serialization::CSerializable::Ptr;

constexpr rlim_t kMemoryOfChild_bytes = rlim_t{512} << 20;
constexpr rlim_t kTimeForObject_s = 10;

// More particles in the movements of an object would take too long to draw again in the parent.
constexpr std::uint64_t kMostParticles = 100'000;

constexpr const char* kContradiction = " is damaged: its contents contradict each other. Fetch the log again";

/// What a message of the child says.
enum class Kind : std::uint8_t {
  kReads,      ///< the child begins to read an object
  kObject,     ///< the text is the object, in the form of MRPT's archives
  kEnd,        ///< the file has ended
  kUserError,  ///< the text is its sentence
  kFailure     ///< the text is that of a SystemFailure
};

/// Precedes the text of a message.
struct Header {
  std::uint64_t text_bytes = 0;
  double progress = 0;  ///< share of the file that has been read
  Kind kind = Kind::kReads;
};

/// Text as a stream for MRPT's archives.
class TextStream {
 public:
  explicit TextStream(std::string text = {}) : text_(std::move(text)) {}

  /// Reads all `size` bytes or none: MRPT would take the first bytes of a number for a number.
  std::size_t Read(void* bytes, std::size_t size) {
    if (text_.size() - taken_ < size) return 0;
    taken_ += text_.copy(static_cast<char*>(bytes), size, taken_);
    return size;
  }
  std::size_t Write(const void* bytes, std::size_t size) {
    text_.append(static_cast<const char*>(bytes), size);
    return size;
  }
  static std::string getStreamDescription() { return "message"; }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t taken_ = 0;
};

using TextArchive = mrpt::serialization::CArchiveStreamBase<TextStream>;

bool is_used(const CObservation& observation) {
  return dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationIMU*>(&observation) != nullptr ||
         dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation) != nullptr;
}

/// Number of particles of all movements, which MRPT draws when it reads them.
std::uint64_t particles_of(const CActionCollection& actions) {
  std::uint64_t particles = 0;
  for (const auto& action : actions) {
    if (const auto* movement = dynamic_cast<const mrpt::obs::CActionRobotMovement2D*>(action.get()))
      particles += movement->motionModelConfiguration.thrunModel.nParticlesCount;
    if (const auto* movement = dynamic_cast<const mrpt::obs::CActionRobotMovement3D*>(action.get()))
      particles += movement->motionModelConfiguration.mm6DOFModel.nParticlesCount;
  }
  return particles;
}

/// Returns a cloud as points, which need less memory than images and packets. Leaves the points out unless
/// `slices` is true. Returns a cloud whose points cannot be read as it is, so that the parent reports it.
CObservation::Ptr as_points(const CObservation::Ptr& cloud, bool slices) {
  auto points = mrpt::obs::CObservationPointCloud::Create();
  points->timestamp = cloud->timestamp;
  points->sensorLabel = cloud->sensorLabel;
  cloud->getSensorPose(points->sensorPose);
  points->pointcloud = mrpt::maps::CSimplePointsMap::Create();
  if (!slices) return points;
  try {
    for (const mrpt::math::TPoint3Df& point : cloud_points(*cloud, ""))
      points->pointcloud->insertPointFast(point.x, point.y, point.z);
  } catch (const UserError&) {
    return cloud;
  }
  return points;
}

/// Returns what psi-slam uses of an observation; null if nothing. Images would take long to send.
CObservation::Ptr used_observation(const CObservation::Ptr& observation, bool slices) {
  if (observation && is_cloud(*observation)) return as_points(observation, slices);
  return observation && is_used(*observation) ? observation : nullptr;
}

}  // namespace

Object used_part(const Object& object, bool slices) {
  if (const auto observation = std::dynamic_pointer_cast<CObservation>(object))
    return used_observation(observation, slices);
  if (auto* frame = dynamic_cast<CSensoryFrame*>(object.get())) {
    const auto used = CSensoryFrame::Create();
    for (const CObservation::Ptr& observation : *frame)
      if (const CObservation::Ptr part = used_observation(observation, slices)) used->insert(part);
    return used;
  }
  return dynamic_cast<const CActionCollection*>(object.get()) != nullptr ? object : nullptr;
}

void find_external_files(const std::filesystem::path& path) {
  // CRawlog::detectImagesDirectory() of MRPT 2.5 omits the slash after the folder of the log.
  const std::string name = path.filename().string();
  std::filesystem::path folder = path.parent_path() / (name.substr(0, name.rfind(".rawlog")) + "_Images");
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) folder = path.parent_path() / "Images";
  mrpt::io::setLazyLoadPathBase(folder.string());
}

namespace {

void lower_limit(int resource, rlim_t most) {
  rlimit limit{};
  ::getrlimit(resource, &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, most);
  ::setrlimit(resource, &limit);
}

/// Limits the memory of this process to kMemoryOfChild_bytes more than it has now.
void limit_memory() {
  rlim_t pages = 0;
  if (std::ifstream("/proc/self/statm") >> pages)
    lower_limit(RLIMIT_AS, pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + kMemoryOfChild_bytes);
}

/// Limits the processor time of this process to kTimeForObject_s more than it has taken.
void limit_time() {
  timespec taken{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &taken);
  rlimit limit{};
  ::getrlimit(RLIMIT_CPU, &limit);
  limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(taken.tv_sec) + 1 + kTimeForObject_s);
  ::setrlimit(RLIMIT_CPU, &limit);
}

/// The child's end of the pipe.
class Sender {
 public:
  explicit Sender(int descriptor) : descriptor_(descriptor) {}

  /// Ends this process if the parent no longer reads.
  void send(Kind kind, double progress, const std::string& text = {}) const {
    Header header;
    header.text_bytes = text.size();
    header.progress = progress;
    header.kind = kind;
    const std::string_view bytes(reinterpret_cast<const char*>(&header), sizeof header);
    if (!write_all(descriptor_, bytes) || !write_all(descriptor_, text)) ::_exit(1);
  }

 private:
  int descriptor_;
};

void send_object(const Object& object, const RawlogStream& objects, const Sender& sender) {
  const auto* actions = dynamic_cast<const CActionCollection*>(object.get());
  TextStream stream;
  try {
    if (actions != nullptr && particles_of(*actions) > kMostParticles) throw std::length_error("particles");
    TextArchive(stream) << *object;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    throw UserError(objects.place() + kContradiction);
  }
  sender.send(Kind::kObject, objects.progress(), stream.text());
}

void send_objects(const std::filesystem::path& path, bool slices, const Sender& sender) {
  try {
    find_external_files(path);
    RawlogStream objects(std::make_unique<CompressedFile>(path), false);
    while (true) {
      sender.send(Kind::kReads, objects.progress());
      limit_time();
      const Object object = objects.next();
      if (!object) break;
      if (const Object used = used_part(object, slices)) send_object(used, objects, sender);
    }
    sender.send(Kind::kEnd, objects.progress());
  } catch (const std::bad_alloc&) {
    ::_exit(1);  // some failed allocations crash MRPT, so the parent reports both in the same way
  } catch (const UserError& error) {
    sender.send(Kind::kUserError, 0, error.what());
  } catch (const std::exception& error) {
    sender.send(Kind::kFailure, 0, error.what());
  }
}

/// The child process. Never returns to the code of the parent. If the parent ends, so does the child when it
/// sends the next object.
[[noreturn]] void read_in_child(const std::filesystem::path& path, bool slices, const Pipe& pipe) {
  constexpr int kPipe = 3;
  ::setpgid(0, 0);  // signals of the terminal are for the parent
  for (const int signal : {SIGPIPE, SIGTERM, SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
    std::signal(signal, SIG_DFL);
  ::close(pipe.reading());
  ::dup2(pipe.writing(), kPipe);
  ::close_range(kPipe + 1, ~0U, 0);  // pipes of the parent would not end before this process
  const int nothing = ::open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  ::close(nothing);
  lower_limit(RLIMIT_CORE, 0);
  limit_memory();
  send_objects(path, slices, Sender(kPipe));
  ::_exit(0);  // calls no destructors and flushes no stream buffers of the parent
}

/// The child does more than call the system, although this process may have other threads. It needs the locks
/// of malloc(), which the C library releases in a child, and of MRPT's classes, which are registered before.
pid_t start_child(const std::filesystem::path& path, bool slices, Pipe& pipe) {
  register_rawlog_classes();
  const pid_t pid = ::fork();
  if (pid < 0) fail_at("cannot start a process that reads " + path.string(), errno);
  if (pid == 0) read_in_child(path, slices, pipe);
  pipe.close_writing();
  return pid;
}

}  // namespace

struct RawlogArchive::State {
  State(std::filesystem::path rawlog, bool slices)
      : path(std::move(rawlog)), child(start_child(path, slices, pipe)) {}

  /// Receives the next object, or null at the end of the file.
  Object receive();

  /// Returns why the child has ended without a message.
  UserError end_of_child();

  std::string place_of(std::uint64_t number) const {
    return path.string() + ": object " + std::to_string(number);
  }

  std::filesystem::path path;
  Pipe pipe;
  RunningChild child;
  std::uint64_t reads = 0;   ///< number of objects that the child has begun to read
  std::uint64_t object = 0;  ///< number of the object that was last received; at the end, of all objects
  double progress = 0;
  bool is_at_end = false;
  std::exception_ptr error;
};

Object RawlogArchive::State::receive() {
  while (!is_at_end) {
    Header header;
    if (!pipe.read_exactly(&header, sizeof header)) throw end_of_child();
    std::string text(header.text_bytes, '\0');
    if (!pipe.read_exactly(text.data(), text.size())) throw end_of_child();
    progress = std::max(progress, header.progress);  // errors state none
    switch (header.kind) {
      case Kind::kReads:
        ++reads;
        break;
      case Kind::kObject: {
        object = reads;
        TextStream stream(std::move(text));
        try {
          return TextArchive(stream).ReadObject();
        } catch (const std::bad_alloc&) {
          throw;
        } catch (const std::exception&) {
          throw UserError(place_of(reads) + kContradiction);
        }
      }
      case Kind::kEnd:
        object = reads - 1;
        is_at_end = true;
        break;
      case Kind::kUserError:
        throw UserError(text);
      case Kind::kFailure:
        throw SystemFailure(text);
    }
  }
  return nullptr;
}

UserError RawlogArchive::State::end_of_child() {
  const int status = child.wait().status;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGKILL || signal == SIGTERM)
    return UserError("the process that reads " + path.string() + " was killed (signal " +
                     std::to_string(signal) + "). Make sure that there is enough memory");
  const std::string reason = signal == SIGXCPU
                                 ? " takes MRPT more than " + std::to_string(kTimeForObject_s) + " s"
                                 : " needs more than " + std::to_string(kMemoryOfChild_bytes >> 20) +
                                       " MiB of memory or crashes MRPT";
  return UserError(place_of(reads) + reason + ", so it is probably damaged. Fetch the log again");
}

RawlogArchive::RawlogArchive(const std::filesystem::path& path, bool slices)
    : state_(std::make_unique<State>(path, slices)) {}
RawlogArchive::~RawlogArchive() = default;

Object RawlogArchive::next() {
  if (state_->error) std::rethrow_exception(state_->error);
  try {
    return state_->receive();
  } catch (...) {
    state_->error = std::current_exception();
    throw;
  }
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
