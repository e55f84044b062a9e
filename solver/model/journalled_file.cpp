// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/journalled_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "base/digest.hpp"
#include "base/error.hpp"

namespace hilo {
namespace {

constexpr char magic[8] = {'h', 'i', 'l', 'o', 'j', 'r', 'n', 'l'};

std::string journal_of(const std::string& path) { return path + ".journal"; }

bool read_all(int file, std::uint64_t at, std::span<std::byte> to) {
  for (size_t done = 0; done < to.size();) {
    const ssize_t n = ::pread(file, to.data() + done, to.size() - done, static_cast<off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    if (n == 0) {  // behind the end
      std::fill(to.begin() + static_cast<std::ptrdiff_t>(done), to.end(), std::byte{0});
      return true;
    }
    done += static_cast<size_t>(n);
  }
  return true;
}

bool write_all(int file, std::uint64_t at, std::span<const std::byte> from) {
  for (size_t done = 0; done < from.size();) {
    const ssize_t n = ::pwrite(file, from.data() + done, from.size() - done, static_cast<off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<size_t>(n);
  }
  return true;
}

bool is_safe(int file) { return ::fdatasync(file) == 0 || errno == EINVAL || errno == EROFS; }

template <class T>
void put(std::vector<std::byte>& out, const T& value) {
  const auto bytes = std::as_bytes(std::span(&value, 1));
  out.insert(out.end(), bytes.begin(), bytes.end());
}
template <class T>
T take(const std::vector<std::byte>& in, size_t& at) {
  T value;
  std::memcpy(&value, in.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

/// Puts the pieces of a journal into the file: end, then (place, length, bytes) of each.
bool put_in_place(int file, const std::vector<std::byte>& journal, size_t at, size_t last) {
  const auto end = take<std::uint64_t>(journal, at);
  while (at + 16 <= last) {
    const auto place = take<std::uint64_t>(journal, at), length = take<std::uint64_t>(journal, at);
    if (length > last - at || !write_all(file, place, std::span(journal).subspan(at, length))) return false;
    at += length;
  }
  return ::ftruncate(file, static_cast<off_t>(end)) == 0;
}

/// As JournalledFile::write_journal leaves it; empty where it was cut off.
std::vector<std::byte> whole_journal(int file) {
  struct stat status;
  if (::fstat(file, &status) != 0 || status.st_size < 24) return {};
  std::vector<std::byte> journal(static_cast<size_t>(status.st_size));
  if (!read_all(file, 0, journal) || std::memcmp(journal.data(), magic, sizeof magic) != 0) return {};
  size_t at = journal.size() - 8;
  const auto digest = take<std::uint64_t>(journal, at);
  return Digest().add(std::span(journal).first(journal.size() - 8)).value() == digest ? journal : std::vector<std::byte>{};
}

// The driver: HDF5 knows a file by H5FD_t, which comes first.
struct Driven {
  H5FD_t by_library{};
  std::unique_ptr<JournalledFile> file;
};
JournalledFile& of(const H5FD_t* f) { return *reinterpret_cast<const Driven*>(f)->file; }

H5FD_t* open_driven(const char* name, unsigned flags, hid_t, haddr_t) {
  const int how = (flags & H5F_ACC_RDWR ? O_RDWR : O_RDONLY) | (flags & H5F_ACC_CREAT ? O_CREAT : 0) | O_CLOEXEC;
  const int descriptor = ::open(name, how, 0666);
  if (descriptor < 0) return nullptr;
  if (flags & H5F_ACC_TRUNC && ::ftruncate(descriptor, 0) != 0) {
    ::close(descriptor);
    return nullptr;
  }
  auto driven = std::make_unique<Driven>();
  driven->file = std::make_unique<JournalledFile>(name, descriptor);
  return &driven.release()->by_library;
}
herr_t close_driven(H5FD_t* f) {
  delete reinterpret_cast<Driven*>(f);
  return 0;
}
int compare_driven(const H5FD_t* a, const H5FD_t* b) {
  struct stat x {
  }, y{};
  ::fstat(of(a).descriptor(), &x), ::fstat(of(b).descriptor(), &y);
  const auto ax = std::pair(x.st_dev, x.st_ino), by = std::pair(y.st_dev, y.st_ino);
  return ax < by ? -1 : ax > by;
}
herr_t query_driven(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA |
           H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}
haddr_t allocated_of(const H5FD_t* f, H5FD_mem_t) { return of(f).allocated; }
herr_t allocate_to(H5FD_t* f, H5FD_mem_t, haddr_t end) { return of(f).allocated = end, 0; }
haddr_t end_of(const H5FD_t* f, H5FD_mem_t) { return of(f).end(); }
herr_t handle_of(H5FD_t* f, hid_t, void** handle) { return *handle = &of(f), 0; }
herr_t read_driven(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t n, void* to) {
  return of(f).read(at, {static_cast<std::byte*>(to), n}) ? 0 : -1;
}
herr_t write_driven(H5FD_t* f, H5FD_mem_t, hid_t, haddr_t at, size_t n, const void* from) {
  return of(f).write(at, {static_cast<const std::byte*>(from), n}) ? 0 : -1;
}
herr_t truncate_driven(H5FD_t* f, hid_t, hbool_t) { return of(f).end_at(of(f).allocated), 0; }

hid_t driver() {
  static const hid_t id = [] {
    static H5FD_class_t c{};
#if H5_VERSION_GE(1, 13, 0)
    c.version = H5FD_CLASS_VERSION, c.value = H5FD_class_value_t{H5_VFD_RESERVED + 44};  // of those that nobody registered, up to 511
#endif
    c.name = "hilo_journal", c.maxaddr = (haddr_t{1} << 62), c.fc_degree = H5F_CLOSE_WEAK;
    c.open = open_driven, c.close = close_driven, c.cmp = compare_driven, c.query = query_driven;
    c.get_eoa = allocated_of, c.set_eoa = allocate_to, c.get_eof = end_of, c.get_handle = handle_of;
    c.read = read_driven, c.write = write_driven, c.truncate = truncate_driven;
    const H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
    std::copy(std::begin(map), std::end(map), c.fl_map);
    return H5FDregister(&c);
  }();
  return id;
}

}  // namespace

void JournalledFile::choose(std::int64_t access) { H5Pset_driver(access, driver(), nullptr); }

JournalledFile& JournalledFile::behind(std::int64_t file) {
  void* handle = nullptr;
  H5Fget_vfd_handle(file, H5P_DEFAULT, &handle);
  return *static_cast<JournalledFile*>(handle);
}

void JournalledFile::recover(const std::string& path) {
  const std::string name = journal_of(path);
  const int journal = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
  if (journal < 0) return;
  const int file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  int error = file < 0 ? errno : 0;
  if (file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0) {  // else it is being committed by who writes it
    if (const auto pieces = whole_journal(journal);
        !pieces.empty() && !(put_in_place(file, pieces, sizeof magic, pieces.size() - 8) && is_safe(file)))
      error = errno;
    if (!error && ::unlink(name.c_str()) != 0 && errno != ENOENT) error = errno;
  }
  ::close(journal);
  if (file >= 0) ::close(file);
  if (error && error != ENOENT)
    throw Error(path, fmt::format("was left in the middle of a write and cannot be mended: {}", std::strerror(error)),
                fmt::format("make it and {} writable", name), Exit::resources);
}

bool JournalledFile::in_commit(const std::string& path) { return ::access(journal_of(path).c_str(), F_OK) == 0; }

JournalledFile::JournalledFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {
  struct stat status {};
  ::fstat(descriptor, &status);
  end_ = committed_ = static_cast<std::uint64_t>(status.st_size);
}

JournalledFile::~JournalledFile() {
  if (end_ != committed_ || !held_.empty()) (void)!::ftruncate(descriptor_, static_cast<off_t>(committed_));
  ::close(descriptor_);
}

bool JournalledFile::fail() {
  if (!error_) error_ = errno ? errno : EIO;
  lost_ = true;
  return false;
}

bool JournalledFile::read(std::uint64_t at, std::span<std::byte> to) {
  if (!read_all(descriptor_, at, to)) return false;
  for (auto piece = held_.upper_bound(at + to.size() - 1); piece != held_.begin();) {
    --piece;
    const std::uint64_t from = piece->first, until = from + piece->second.size();
    if (until <= at) break;
    const std::uint64_t a = std::max(from, at), b = std::min<std::uint64_t>(until, at + to.size());
    std::copy(piece->second.begin() + static_cast<std::ptrdiff_t>(a - from), piece->second.begin() + static_cast<std::ptrdiff_t>(b - from),
              to.begin() + static_cast<std::ptrdiff_t>(a - at));
  }
  return true;
}

bool JournalledFile::write(std::uint64_t at, std::span<const std::byte> from) {
  if (lost_) return true;
  end_ = std::max(end_, at + from.size());
  if (at + from.size() > committed_) {
    const std::uint64_t fresh = std::max(at, committed_);
    if (!write_all(descriptor_, fresh, from.subspan(fresh - at))) return fail();
    from = from.first(fresh - at);
  }
  if (from.empty()) return true;
  // one piece of all that it touches
  auto first = held_.upper_bound(at);
  if (first != held_.begin() && std::prev(first)->first + std::prev(first)->second.size() >= at) --first;
  auto last = first;
  std::uint64_t begin = at, end = at + from.size();
  for (; last != held_.end() && last->first <= end; ++last)
    begin = std::min(begin, last->first), end = std::max<std::uint64_t>(end, last->first + last->second.size());
  if (first != last && first->first == begin && first->first + first->second.size() == end) {  // it lies in one
    std::copy(from.begin(), from.end(), first->second.begin() + static_cast<std::ptrdiff_t>(at - begin));
    return true;
  }
  std::vector<std::byte> piece(end - begin);
  for (auto p = first; p != last; ++p)
    std::copy(p->second.begin(), p->second.end(), piece.begin() + static_cast<std::ptrdiff_t>(p->first - begin));
  std::copy(from.begin(), from.end(), piece.begin() + static_cast<std::ptrdiff_t>(at - begin));
  held_.erase(first, last);
  held_.emplace(begin, std::move(piece));
  return true;
}

bool JournalledFile::commit(bool safe) {
  if (lost_) return false;
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) return fail();
  if (static_cast<std::uint64_t>(status.st_size) < end_ && ::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) return fail();
  if (safe && !is_safe(descriptor_)) return fail();
  if (committed_ == 0) {  // nothing that could be overwritten
    if (::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) return fail();
    committed_ = end_;
    return true;
  }
  if (held_.empty() && end_ == committed_) return true;
  std::vector<std::byte> journal;
  for (const char c : magic) journal.push_back(static_cast<std::byte>(c));
  put(journal, end_);
  for (const auto& [place, bytes] : held_) {
    put(journal, place), put(journal, static_cast<std::uint64_t>(bytes.size()));
    journal.insert(journal.end(), bytes.begin(), bytes.end());
  }
  put(journal, Digest().add(journal).value());
  const std::string name = journal_of(path_);
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  bool ok = file >= 0 && write_all(file, 0, journal) && (!safe || is_safe(file));
  if (file >= 0 && ::close(file) != 0) ok = false;
  if (!ok) {
    const int error = errno;
    ::unlink(name.c_str());
    errno = error;
    return fail();
  }
  held_.clear(), committed_ = end_;
  if (!put_in_place(descriptor_, journal, sizeof magic, journal.size() - 8) || (safe && !is_safe(descriptor_)))
    return fail();  // the journal stays for recover()
  ::unlink(name.c_str());
  return true;
}

bool JournalledFile::rename(const std::string& to) {
  recover(to);  // or the journal of the file that is replaced would be taken for one of this
  if (::rename(path_.c_str(), to.c_str()) != 0) return fail();
  path_ = to;
  return true;
}

}  // namespace hilo
