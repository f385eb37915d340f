// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_journal.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/atomic_file.h"
#include "base/thread_priority.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace {

/// Creates the file of a journal with its first chunk.
FileTail begun_journal(const std::filesystem::path& path, const std::string& first_chunk) {
  AtomicFile file(path);
  file.write(first_chunk);
  return {path, file.move_into_place(), first_chunk.size()};
}

}  // namespace

SessionJournal::SessionJournal(std::filesystem::path path, const SessionFacts& facts,
                               const std::vector<Frame>& frames, double period_s)
    : path_(std::move(path)),
      period_(period_s),
      tail_(begun_journal(path_, chunks_.next(facts, frames))),
      thread_([this] { work(); }) {}

SessionJournal::~SessionJournal() {
  end();
}

void SessionJournal::add(Frame frame, SessionFacts facts) {
  const std::lock_guard lock(mutex_);
  if (stop_) return;
  frames_.push_back(std::move(frame));
  facts_ = std::move(facts);
  changed_.notify_all();
}

void SessionJournal::update(SessionFacts facts) {
  const std::lock_guard lock(mutex_);
  if (stop_) return;
  facts_ = std::move(facts);
  changed_.notify_all();
}

void SessionJournal::remove() {
  end();
  struct stat mine {};
  struct stat named {};
  const bool is_mine = ::fstat(tail_.file().number(), &mine) == 0 && ::stat(path_.c_str(), &named) == 0 &&
                       mine.st_dev == named.st_dev && mine.st_ino == named.st_ino;
  if (is_mine && ::unlink(path_.c_str()) != 0)
    throw SystemFailure("cannot delete " + path_.string() + ": " + std::strerror(errno));
}

std::optional<std::string> SessionJournal::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void SessionJournal::end() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SessionJournal::work() {
  set_priority_of_this_thread(ThreadPriority::kLow);
  std::unique_lock lock(mutex_);
  auto next = Clock::now();
  for (bool is_last = false; !is_last;) {
    if (!failure_) changed_.wait(lock, [this] { return stop_ || facts_.has_value(); });
    changed_.wait_until(lock, next, [this] { return stop_; });
    next = Clock::now() + std::chrono::duration_cast<Clock::duration>(period_);
    const std::vector<Frame> frames = std::exchange(frames_, {});
    std::optional<SessionFacts> facts = std::exchange(facts_, std::nullopt);
    is_last = stop_;
    lock.unlock();
    std::optional<std::string> failure;
    bool is_packed = false;
    try {
      if (facts) tail_.append(chunks_.next(*std::move(facts), frames));
      is_packed = true;
      tail_.write();
    } catch (const std::exception& error) {
      failure = error.what();
    }
    lock.lock();
    failure_ = std::move(failure);
    if (!is_packed) is_last = stop_ = true;  // later chunks need this one
  }
}

}  // namespace psi_slam
