// SPDX-License-Identifier: GPL-3.0-or-later
// A library to preload: the n-th change of an .h5 file or of one beside it (.new, .journal, .tmp-...) does not succeed.
//   FAIL_AT=n    which one, counted over the process
//   FAIL_HOW     kill: half of it is written, then the process is killed; an errno (28 no space, 5 input/output): this one fails and all
//                that follow
//   FAIL_COUNT   file that gets the number of changes when the process ends
//   FAIL_CLOCK   the time of day is off by up to so many seconds, otherwise at each question
//   FAIL_HASTE   so many milliseconds go by at each question for the time
//   FAIL_LOG     file that gets every change and every sync, in order: lines "what path [path or place length]", bytes behind them
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

long counted = 0;

const char* variable(const char* name) {
  const char* text = std::getenv(name);
  return text ? text : "";
}

bool is_ours(const char* path) {
  const char* const parts[] = {".h5", ".new", ".journal"};
  for (const char* part : parts)
    if (std::strstr(path, part)) return true;
  return false;
}

/// Whether the change that comes now must fail; `kill`: after half of it.
bool fails(bool& kill) {
  static const long at = std::atol(variable("FAIL_AT"));
  static const char* const how = variable("FAIL_HOW");
  ++counted;
  kill = std::strcmp(how, "kill") == 0;
  if (at <= 0 || counted < at) return false;
  if (!kill) errno = std::atoi(how);
  return true;
}

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(::dlsym(RTLD_NEXT, name));
}

/// The name of an open file.
struct Name {
  char text[4096] = "";
  explicit Name(int file) {
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t n = ::readlink(link, text, sizeof text - 1);
    text[n > 0 ? n : 0] = '\0';
  }
};

bool is_ours(int file) { return is_ours(Name(file).text); }

/// A line of FAIL_LOG, with the bytes behind it.
void tell(const char* line, const void* bytes = nullptr, size_t n = 0) {
  static const int log = *variable("FAIL_LOG") ? ::open(variable("FAIL_LOG"), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666) : -1;
  if (log < 0) return;
  if (::write(log, line, std::strlen(line)) < 0 || (n > 0 && ::write(log, bytes, n) < 0)) std::abort();
}

struct Count {
  ~Count() {
    if (std::FILE* out = std::fopen(variable("FAIL_COUNT"), "w")) std::fprintf(out, "%ld\n", counted), std::fclose(out);
  }
} count;

void tell_of(const char* what, const char* from, const char* to) {
  char line[9000];
  std::snprintf(line, sizeof line, "%s %s %s\n", what, from, to);
  tell(line);
}

/// What the time of day is off by [s].
long jump() {
  static const long most = std::atol(variable("FAIL_CLOCK"));
  static thread_local unsigned state = 1;
  state = state * 1664525 + 1013904223;
  return most > 0 ? static_cast<long>(state >> 8) % (2 * most + 1) - most : 0;
}

ssize_t write_some(int file, const void* from, size_t n, off_t at) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  bool kill = false;
  if (is_ours(file) && fails(kill)) {
    if (!kill) return -1;
    real(file, from, n / 2, at);
    std::raise(SIGKILL);
  }
  const ssize_t written = real(file, from, n, at);
  if (const Name name(file); written >= 0 && is_ours(name.text)) {
    char line[4300];
    std::snprintf(line, sizeof line, "write %s %lld %zd\n", name.text, static_cast<long long>(at), written);
    tell(line, from, static_cast<size_t>(written));
  }
  return written;
}

int sync_with(const char* call, int file) {
  const int result = next<int (*)(int)>(call)(file);
  if (const Name name(file); result == 0 && is_ours(name.text)) tell_of("sync", name.text, "");
  return result;
}

}  // namespace

extern "C" {

ssize_t pwrite(int file, const void* from, size_t n, off_t at) { return write_some(file, from, n, at); }
ssize_t pwrite64(int file, const void* from, size_t n, off_t at) { return write_some(file, from, n, at); }
int ftruncate(int file, off_t end) {
  static const auto real = next<int (*)(int, off_t)>("ftruncate");
  bool kill = false;
  if (is_ours(file) && fails(kill)) {
    if (!kill) return -1;
    std::raise(SIGKILL);
  }
  const int result = real(file, end);
  if (const Name name(file); result == 0 && is_ours(name.text)) {
    char length[32];
    std::snprintf(length, sizeof length, "%lld", static_cast<long long>(end));
    tell_of("end", name.text, length);
  }
  return result;
}
int ftruncate64(int file, off_t end) { return ftruncate(file, end); }
int fsync(int file) { return sync_with("fsync", file); }
int fdatasync(int file) { return sync_with("fdatasync", file); }
int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  bool kill = false;
  if (is_ours(to) && fails(kill)) {
    if (!kill) return -1;
    std::raise(SIGKILL);
  }
  if (is_ours(to)) tell_of("rename", from, to);
  return real(from, to);
}
int unlink(const char* path) {
  static const auto real = next<int (*)(const char*)>("unlink");
  bool kill = false;
  if (is_ours(path) && std::strcmp(variable("FAIL_HOW"), "kill") == 0 && fails(kill)) std::raise(SIGKILL);
  if (is_ours(path)) tell_of("unlink", path, "");
  return real(path);
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec += jump();
  if (clock == CLOCK_MONOTONIC) {
    static const long each = std::atol(variable("FAIL_HASTE"));
    static std::atomic<long> gone = 0;
    const long ms = gone += each;
    now->tv_sec += ms / 1000;
    now->tv_nsec += ms % 1000 * 1000000;
    if (now->tv_nsec >= 1000000000) now->tv_nsec -= 1000000000, ++now->tv_sec;
  }
  return result;
}
int gettimeofday(timeval* now, void* zone) noexcept {
  static const auto real = next<int (*)(timeval*, void*)>("gettimeofday");
  const int result = real(now, zone);
  now->tv_sec += jump();
  return result;
}
time_t time(time_t* now) noexcept {
  timespec exact{};
  clock_gettime(CLOCK_REALTIME, &exact);
  if (now) *now = exact.tv_sec;
  return exact.tv_sec;
}

}  // extern "C"
