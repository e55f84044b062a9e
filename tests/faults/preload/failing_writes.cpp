// A library to preload: the n-th change of an .h5 file or of one beside it (.new, .journal, .tmp-...) does not succeed.
//   FAIL_AT=n    which one, counted over the process
//   FAIL_HOW     kill: half of it is written, then the process is killed; an errno (28 no space, 5 input/output): this one fails and all
//                that follow
//   FAIL_COUNT   file that gets the number of changes when the process ends
//   FAIL_CLOCK   the time of day is off by up to so many seconds, otherwise at each question
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/time.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

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
bool is_ours(int file) {
  char link[64], path[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t n = ::readlink(link, path, sizeof path - 1);
  if (n <= 0) return false;
  path[n] = '\0';
  return is_ours(path);
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

struct Count {
  ~Count() {
    if (std::FILE* out = std::fopen(variable("FAIL_COUNT"), "w")) std::fprintf(out, "%ld\n", counted), std::fclose(out);
  }
} count;

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
  return real(file, from, n, at);
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
  return real(file, end);
}
int ftruncate64(int file, off_t end) { return ftruncate(file, end); }
int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  bool kill = false;
  if (is_ours(to) && fails(kill)) {
    if (!kill) return -1;
    std::raise(SIGKILL);
  }
  return real(from, to);
}
int unlink(const char* path) {
  static const auto real = next<int (*)(const char*)>("unlink");
  bool kill = false;
  if (is_ours(path) && std::strcmp(variable("FAIL_HOW"), "kill") == 0 && fails(kill)) std::raise(SIGKILL);
  return real(path);
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  static const auto real = next<int (*)(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec += jump();
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
