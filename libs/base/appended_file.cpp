// SPDX-License-Identifier: BSD-3-Clause
#include "base/appended_file.h"

#include <fcntl.h>

#include <cerrno>
#include <chrono>
#include <exception>
#include <utility>

#include "base/partial_files.h"
#include "base/thread_priority.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::chrono::seconds kRetryPeriod{1};

Descriptor created_file(const std::filesystem::path& path, bool overwrite) {
  constexpr int kMode = 0666;  // the umask applies
  const int how = overwrite ? O_TRUNC : O_EXCL;
  Descriptor file(::open(path.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC | how, kMode));
  if (!file.is_open() && errno == EEXIST)
    throw UserError(
        path.string() +
        " exists already, expected the name of a new file. Choose another name, or delete the file");
  if (!file.is_open()) throw cannot_create(path, errno);
  wait_for_disk(folder_of(path), path);
  return file;
}

}  // namespace

AppendedFile::AppendedFile(const std::filesystem::path& path, bool overwrite)
    : tail_(path, created_file(path, overwrite), 0), thread_([this] { work(); }) {}

AppendedFile::~AppendedFile() {
  close();
}

bool AppendedFile::append(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (waiting_bytes_ > 0 && waiting_bytes_ + bytes.size() > kMostWaitingBytes) return false;
  appended_ += bytes;
  waiting_bytes_ += bytes.size();
  changed_.notify_all();
  return true;
}

void AppendedFile::close() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::optional<std::string> AppendedFile::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void AppendedFile::work() {
  set_priority_of_this_thread(ThreadPriority::kLow);
  std::unique_lock lock(mutex_);
  for (bool is_last = false; !is_last;) {
    if (failure_) {
      changed_.wait_for(lock, kRetryPeriod, [this] { return stop_; });
    } else {
      changed_.wait(lock, [this] { return stop_ || !appended_.empty(); });
    }
    is_last = stop_;
    tail_.append(std::exchange(appended_, {}));
    lock.unlock();
    std::optional<std::string> failure;
    try {
      tail_.write();
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    waiting_bytes_ = tail_.unwritten_bytes() + appended_.size();
    failure_ = std::move(failure);
  }
}

}  // namespace psi_slam
