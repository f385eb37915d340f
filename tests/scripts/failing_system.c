// SPDX-License-Identifier: BSD-3-Clause
// A library to preload: makes calls of the C library fail that write below a folder or read a file, truncates a file while it is
// read, and sets the clock back. Environment variables say what happens:
//
//     PSI_FAULT_FOLDER    calls that write files below this absolute path are counted from 1
//     PSI_FAULT_CALL      number of the call that fails
//     PSI_FAULT_KIND      enospc: the call fails, and all later ones that need space; eio: only this call fails; short: the call
//                         writes half of its bytes, and all later ones that need space fail; kill: the process is killed before
//                         the call
//     PSI_FAULT_TRACE     file with one line for each counted call: number, name, path, "failed" if it is the call that fails
//     PSI_FAULT_READ      absolute path of a file whose reads are counted from 1
//     PSI_FAULT_READ_END  bytes of this file that can be read; reading further fails with EIO
//     PSI_FAULT_READ_CUT  number of a read before which the file is truncated to PSI_FAULT_READ_END bytes, and no read fails
//     PSI_FAULT_CLOCK     number of a call that asks for the date; from this call on, the clock is an hour behind
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

#define REAL(result, name, ...)                                                         \
  static result (*real)(__VA_ARGS__);                                                   \
  if (!real) real = (result(*)(__VA_ARGS__))dlsym(RTLD_NEXT, #name)

static atomic_long calls, reads, dates;
static atomic_int is_full;

static long number_of(const char* variable) {
  const char* text = getenv(variable);
  return text ? atol(text) : -1;
}

static int is_kind(const char* kind) {
  const char* chosen = getenv("PSI_FAULT_KIND");
  return chosen && strcmp(chosen, kind) == 0;
}

static int is_below(const char* path, const char* variable) {
  const char* folder = getenv(variable);
  char whole[2 * PATH_MAX];
  if (!folder || !path) return 0;
  if (path[0] == '/') {
    snprintf(whole, sizeof whole, "%s", path);
  } else {
    char here[PATH_MAX];
    if (!getcwd(here, sizeof here)) return 0;
    snprintf(whole, sizeof whole, "%s/%s", here, path);
  }
  return strncmp(whole, folder, strlen(folder)) == 0;
}

static const char* path_of(int file, char path[PATH_MAX]) {
  char link[64];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, PATH_MAX - 1);
  path[length < 0 ? 0 : length] = '\0';
  return path;
}

static void trace(long number, const char* name, const char* path, int fails) {
  const char* file = getenv("PSI_FAULT_TRACE");
  if (!file) return;
  char line[PATH_MAX + 100];
  const int length = snprintf(line, sizeof line, "%ld %s %s%s\n", number, name, path, fails ? " failed" : "");
  const int out = (int)syscall(SYS_openat, AT_FDCWD, file, O_CREAT | O_APPEND | O_WRONLY | O_CLOEXEC, 0666);
  if (out < 0) return;
  syscall(SYS_write, out, line, (size_t)length);
  syscall(SYS_close, out);
}

enum Fate { kWorks, kFails, kIsShort };

/// Fate of a call that writes `path`. Sets errno unless it works. A call that writes no bytes fails instead of being short.
static enum Fate fate_of(const char* name, const char* path, int needs_space) {
  if (!is_below(path, "PSI_FAULT_FOLDER")) return kWorks;
  const long number = ++calls;
  const int is_chosen = number == number_of("PSI_FAULT_CALL");
  trace(number, name, path, is_chosen);
  if (is_chosen && is_kind("kill")) raise(SIGKILL);
  if (is_chosen && !is_kind("eio")) is_full = 1;
  if (!is_chosen && !(is_full && needs_space)) return kWorks;
  errno = is_chosen && is_kind("eio") ? EIO : ENOSPC;
  return is_chosen && is_kind("short") ? kIsShort : kFails;
}

static int open_file(int folder, const char* path, int flags, mode_t mode) {
  const int creates = (flags & O_CREAT) != 0;
  if ((flags & O_ACCMODE) != O_RDONLY && fate_of("open", path, creates) != kWorks) return -1;
  return (int)syscall(SYS_openat, folder, path, flags, mode);
}

#define OPEN(name)                                                                      \
  int name(const char* path, int flags, ...) {                                          \
    va_list more;                                                                       \
    va_start(more, flags);                                                              \
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;                     \
    va_end(more);                                                                       \
    return open_file(AT_FDCWD, path, flags, mode);                                      \
  }
OPEN(open)
OPEN(open64)

ssize_t write(int file, const void* bytes, size_t size) {
  char path[PATH_MAX];
  const enum Fate fate = fate_of("write", path_of(file, path), 1);
  return fate == kFails ? -1 : syscall(SYS_write, file, bytes, fate == kIsShort ? size / 2 : size);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t offset) {
  char path[PATH_MAX];
  const enum Fate fate = fate_of("pwrite", path_of(file, path), 1);
  return fate == kFails ? -1 : syscall(SYS_pwrite64, file, bytes, fate == kIsShort ? size / 2 : size, offset);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
  return pwrite(file, bytes, size, offset);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  char path[PATH_MAX];
  const enum Fate fate = fate_of("writev", path_of(file, path), 1);
  if (fate == kFails) return -1;
  if (fate == kWorks) return syscall(SYS_writev, file, parts, count);
  const struct iovec* last = &parts[count - 1];
  const ssize_t before = syscall(SYS_writev, file, parts, count - 1);
  return before < 0 ? before : before + syscall(SYS_write, file, last->iov_base, last->iov_len / 2);
}

#define SYNC(name)                                                                      \
  int name(int file) {                                                                  \
    char path[PATH_MAX];                                                                \
    return fate_of(#name, path_of(file, path), 0) == kWorks ? (int)syscall(SYS_##name, file) : -1; \
  }
SYNC(fsync)
SYNC(fdatasync)

int ftruncate(int file, off_t size) {
  char path[PATH_MAX];
  return fate_of("ftruncate", path_of(file, path), 0) == kWorks ? (int)syscall(SYS_ftruncate, file, size) : -1;
}

int mkdir(const char* path, mode_t mode) {
  return fate_of("mkdir", path, 1) == kWorks ? (int)syscall(SYS_mkdirat, AT_FDCWD, path, mode) : -1;
}

int rename(const char* from, const char* to) {
  if (fate_of("rename", to, 0) != kWorks) return -1;
  return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlink(const char* path) {
  return fate_of("unlink", path, 0) == kWorks ? (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0) : -1;
}

int remove(const char* path) {
  REAL(int, remove, const char*);
  return fate_of("remove", path, 0) == kWorks ? real(path) : -1;
}

/// Returns how many of the bytes at the offset of a file can be read. Returns -1 and sets errno if none can.
static ssize_t readable(int file, size_t size) {
  char path[PATH_MAX];
  if (!getenv("PSI_FAULT_READ") || !is_below(path_of(file, path), "PSI_FAULT_READ")) return (ssize_t)size;
  const off_t end = number_of("PSI_FAULT_READ_END");
  const long number = ++reads;
  trace(number, "read", path, 0);
  const long cut = number_of("PSI_FAULT_READ_CUT");
  if (cut == number) syscall(SYS_truncate, path, end);
  if (end < 0 || cut >= 0) return (ssize_t)size;
  const off_t at = lseek(file, 0, SEEK_CUR);
  if (at + (off_t)size <= end) return (ssize_t)size;
  errno = EIO;
  return at < end ? end - at : -1;
}

ssize_t read(int file, void* bytes, size_t size) {
  const ssize_t count = readable(file, size);
  return count < 0 ? -1 : syscall(SYS_read, file, bytes, (size_t)count);
}

static time_t hours_back(void) {
  const long first = number_of("PSI_FAULT_CLOCK");
  return first >= 0 && ++dates >= first ? 1 : 0;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = (int)syscall(SYS_clock_gettime, clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec -= 3600 * hours_back();
  return result;
}

int gettimeofday(struct timeval* now, void* zone) {
  const int result = (int)syscall(SYS_gettimeofday, now, zone);
  now->tv_sec -= 3600 * hours_back();
  return result;
}

time_t time(time_t* now) {
  const time_t seconds = (time_t)syscall(SYS_time, NULL) - 3600 * hours_back();
  if (now) *now = seconds;
  return seconds;
}
