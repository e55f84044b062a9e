// SPDX-License-Identifier: GPL-3.0-or-later
// Store: a file is walked through by a child first.  The HDF5 library trusts what a file says of itself; a damaged one makes it crash, go
// round in circles or ask for memory without end.  There that happens to a process that nobody needs.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <ctime>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "model/store_impl.hpp"

namespace hilo {
namespace {

constexpr unsigned most_seconds = 20;      // of the walk; a sound file takes milliseconds
constexpr rlim_t most_memory = 2ul << 30;  // that the walk may take beyond what the process has [bytes]

constexpr int other_attributes = 3, no_way_through = 4;  // exit statuses of the child

/// Which of the types that attributes are written in; -1: none.
int kind_of_number(hid_t type) {
  const hid_t kinds[] = {H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U64LE};
  const auto found = std::find_if(std::begin(kinds), std::end(kinds), [&](hid_t kind) { return H5Tequal(type, kind) > 0; });
  return found == std::end(kinds) ? -1 : static_cast<int>(found - std::begin(kinds));
}

/// Texts are read, since their places in the file are only found by reading; so are attributes.  Numbers are not.
herr_t look_at_attribute(hid_t object, const char* name, const H5A_info_t*, void* digest) {
  if (std::string_view(name) == attributes_digest_name) return 0;
  const Id a(H5Aopen(object, name, H5P_DEFAULT), H5Aclose), type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  const auto n = H5Sget_simple_extent_npoints(space);
  const size_t size = H5Tget_size(type);
  if (!a.ok() || n < 0 || n > 1000 || size > 1 << 20) return 0;
  std::vector<char> value(static_cast<size_t>(n) * std::max<size_t>(size, 8));
  const bool is_text = H5Tis_variable_str(type) > 0;
  if (H5Aread(a, type, value.data()) < 0) return 0;
  Digest& sum = static_cast<Digest*>(digest)->add(std::string_view(name)).add(n).add(size);
  sum.add(is_text ? static_cast<int>(H5Tget_cset(type)) : kind_of_number(type));
  if (!is_text) return sum.add(std::string_view(value.data(), static_cast<size_t>(n) * size)), 0;
  for (hssize_t k = 0; k < n; ++k) {
    const char* text = reinterpret_cast<const char* const*>(value.data())[k];
    sum.add(std::string_view(text ? text : ""));
  }
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, value.data());
  return 0;
}

void look_at_array(hid_t array, hsize_t file_size) {
  const Id type(H5Dget_type(array), H5Tclose), space(H5Dget_space(array), H5Sclose), how(H5Dget_create_plist(array), H5Pclose);
  H5Dget_storage_size(array);
  hsize_t chunks = 0;
  if (H5Pget_layout(how) == H5D_CHUNKED) H5Dget_num_chunks(array, space, &chunks);
  const auto n = H5Sget_simple_extent_npoints(space);
  if (H5Tis_variable_str(type) <= 0 || n <= 0 || static_cast<hsize_t>(n) > file_size) return;
  std::vector<char*> texts(static_cast<size_t>(n), nullptr);
  if (H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()) >= 0) H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
}

struct Look {
  hsize_t file_size = 0;  // 0: at attributes alone
  Digest attributes{};
};

herr_t look_at_object(hid_t root, const char* name, const H5O_info_t* what, void* data) {
  Look& look = *static_cast<Look*>(data);
  const Id object(H5Oopen(root, name, H5P_DEFAULT), H5Oclose);
  if (!object.ok()) return 0;
  look.attributes.add(std::string_view(name));
  hsize_t at = 0;
  if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &at, look_at_attribute, &look.attributes) < 0) return -1;
  if (what->type == H5O_TYPE_DATASET && look.file_size > 0) look_at_array(object, look.file_size);
  return 0;
}

/// The digest that a file says its attributes have, where it says one.
std::optional<std::uint64_t> written_digest(hid_t file) {
  std::uint64_t value = 0;
  if (H5Aexists(file, attributes_digest_name) <= 0) return {};
  const Id a(H5Aopen(file, attributes_digest_name, H5P_DEFAULT), H5Aclose);
  if (!a.ok() || H5Aread(a, H5T_NATIVE_UINT64, &value) < 0) return 0;
  return value;
}

[[noreturn]] void walk(const std::string& path, hsize_t file_size) {
  for (const int s : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGALRM, SIGXCPU}) std::signal(s, SIG_DFL);
  const rlimit no_core{0, 0}, cpu{most_seconds, most_seconds};
  setrlimit(RLIMIT_CORE, &no_core);
  setrlimit(RLIMIT_CPU, &cpu);
  rlimit room;
  if (std::FILE* f = std::fopen("/proc/self/statm", "r")) {
    unsigned long pages = 0;
    if (std::fscanf(f, "%lu", &pages) == 1 && getrlimit(RLIMIT_AS, &room) == 0) {
      room.rlim_cur = std::min<rlim_t>(room.rlim_max, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + most_memory);
      setrlimit(RLIMIT_AS, &room);
    }
    std::fclose(f);
  }
  if (const int nothing = ::open("/dev/null", O_WRONLY); nothing >= 0) {  // what the C library says as it aborts is no message of ours
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  alarm(3 * most_seconds);
  try {
    const Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (file.ok()) {
      Look look{file_size};
      if (H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, look_at_object, &look) < 0) _exit(no_way_through);  // who reads on may find no end
      if (const auto written = written_digest(file); written && *written != look.attributes.value()) _exit(other_attributes);
    }
  } catch (...) {  // no memory
  }
  _exit(0);  // what is merely wrong is found again, and told, by who reads it
}

}  // namespace

std::uint64_t digest_of_attributes(hid_t file) {
  Look look;
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, look_at_object, &look);
  return look.attributes.value();
}

FileState state_of(const std::string& path) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME_COARSE, &now);  // of file systems
  const double age = static_cast<double>(now.tv_sec - s.st_mtim.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec - s.st_mtim.tv_nsec);
  return {{s.st_dev, s.st_ino}, {s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec}, JournalledFile::in_commit(path), std::abs(age) < 0.02};
}

FileState settled(const std::string& path) {
  FileState now = state_of(path);
  for (int k = 0; now.in_commit && k < 100; ++k) ::usleep(2000), now = state_of(path);
  return now;
}

void walk_in_child(const std::string& path) {
  struct stat s;
  if (::stat(path.c_str(), &s) != 0 || !S_ISREG(s.st_mode)) return;  // told by who opens it
  using Seen = std::tuple<dev_t, ino_t, off_t, time_t, long>;
  static std::set<Seen> seen;
  const Seen now{s.st_dev, s.st_ino, s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec};
  if (seen.contains(now)) return;
  const pid_t child = ::fork();
  if (child < 0) return;  // no room for another process: as well without
  if (child == 0) walk(path, static_cast<hsize_t>(s.st_size));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == other_attributes)
    throw Error(path, "damaged: its attributes are not what was written", "make it again, or copy it again");
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_way_through)
    throw Error(path, "damaged: its objects and attributes cannot be listed", "make it again, or copy it again");
  if (!WIFSIGNALED(status)) return void(seen.insert(now));
  const bool endless = WTERMSIG(status) == SIGALRM || WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL;
  throw Error(path, fmt::format("damaged: the HDF5 library {} it", endless ? "comes to no end with" : "crashes on"),
              "make it again, or copy it again");
}

}  // namespace hilo
