// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 through its C interface.  The library is the Open MPI build, used here with the POSIX driver alone: MPI is never initialised.
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/store_impl.hpp"

namespace hilo {
namespace fs = std::filesystem;

void start_library() {
  static const bool once = [] {
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);  // a growing file may be read while it is written
    H5dont_atexit();  // every file is closed here; one that could not be closed (full disk) would crash the library's own closing
    const int told = fcntl(2, F_DUPFD_CLOEXEC, 3), nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere >= 0) dup2(nowhere, 2);  // the library is silent only once it has started
    const bool started = H5open() >= 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
    if (told >= 0) dup2(told, 2);
    for (const int file : {told, nowhere}) ::close(file);
    if (!started) throw Error("", "the HDF5 library cannot start: not enough memory", "raise the limit (ulimit -v)", Exit::resources);
    return true;
  }();
  (void)once;
}

Cause last_cause() {
  Cause cause;
  const auto look = [](unsigned, const H5E_error2_t* e, void* data) -> herr_t {
    auto& c = *static_cast<Cause*>(data);
    const std::string text = e->desc ? e->desc : "";
    if (const auto at = text.find("errno = "); at != std::string::npos) c.error = std::atoi(text.c_str() + at + 8);
    if (c.text.empty()) c.text = text;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, look, &cause);
  return cause;
}

std::set<Store::Impl*> Store::Impl::readers;

Store::Impl::~Impl() {
  readers.erase(this);
  if (growing) growing->give_up();
  if (file.ok()) close();
  if (temporary) ::unlink(on_disk.c_str());
  if (lock >= 0) ::close(lock);
}

bool Store::Impl::close() {
  rows.clear();
  growing = nullptr;
  return H5Fclose(file.release()) >= 0;
}

void Store::Impl::abandon() {
  if (growing) return growing->give_up();
  void* handle = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || !handle) return;
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (nowhere < 0) return;
  ::dup2(nowhere, *static_cast<int*>(handle));
  ::close(nowhere);
}

void Store::Impl::fail_write(const std::string& what) {
  Cause cause = last_cause();
  if (growing && growing->error()) cause.error = growing->error();
  if (!cause.error && grows_on) throw Error(path, fmt::format("damaged: {}: {}", what, cause.text), "copy it again");
  if (!cause.error) throw Error(path, fmt::format("{}: {}", what, cause.text), "", Exit::fault);
  abandon();
  if (temporary) ::unlink(on_disk.c_str());
  throw Error(path, fmt::format("cannot write: {}", std::strerror(cause.error)), "", Exit::resources);
}

void Store::Impl::fail_read(const std::string& array) const {
  const Cause cause = last_cause();
  throw Error(path, fmt::format("{} cannot be read{}{}", array, cause.text.empty() ? "" : ": ", cause.text), "damaged or truncated?");
}

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;
const std::string& Store::path() const { return impl_->path; }

namespace {

Id reading() {
  Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // A file behind a link is opened once, not for every array.  The library does so with its own way of closing; with another one
  // (H5F_CLOSE_STRONG) here or where files are made we could not open that file too.
  H5Pset_elink_file_cache_size(access, 4);
  return access;
}

}  // namespace

Store Store::open(const std::string& path) {
  start_library();
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == EACCES) throw Error(path, "cannot read: Permission denied", "", Exit::resources);
    throw Error(path, "no such file");
  }
  if (S_ISDIR(status.st_mode)) throw Error(path, "is a folder, not a file");
  if (!S_ISREG(status.st_mode)) throw Error(path, "is a device or pipe, not a file");
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);  // opened by hand first: the library hides why it could not
  if (descriptor < 0) throw Error(path, fmt::format("cannot read: {}", std::strerror(errno)), "", Exit::resources);
  ::close(descriptor);
  JournalledFile::recover(path);
  if (status.st_size == 0) throw Error(path, "empty file");
  return while_it_grows(path, [&](const FileState& now) {
    if (H5Fis_hdf5(path.c_str()) <= 0) throw Error(path, "not an HDF5 file");
    Impl::forget_other_states(now);
    walk_in_child(path);
    auto impl = std::make_unique<Impl>();
    impl->path = impl->on_disk = path;
    impl->reopen(now);
    Impl::readers.insert(impl.get());
    Store store(std::move(impl));
    std::vector<std::string> chain;
    Impl::follow_links(store, chain);
    return store;
  });
}

void Store::Impl::open_to_read() {
  const Id access = reading();
  file = Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (file.ok()) return;
  const Cause cause = last_cause();
  const bool cut = cause.text.find("truncated") != std::string::npos || cause.text.find("eof") != std::string::npos;
  throw Error(path, cut ? "truncated file" : fmt::format("truncated or damaged HDF5 file: {}", cause.text));
}

void Store::Impl::forget_other_states(const FileState& now) {
  for (Impl* reader : readers)
    if (reader->opened.file == now.file && !reader->opened.lasts(now)) reader->file = Id(), reader->names.clear();
}

void Store::Impl::reopen(const FileState& now) {
  forget_other_states(now);
  opened = now, names.clear(), file = Id();
  open_to_read();
}

/// Files behind the links of a file that is read are read as well; links that lead in a circle are refused by name.  `chain`: the files
/// that led here.
void Store::Impl::follow_links(Store& store, std::vector<std::string>& chain) {
  const std::string& path = store.path();
  note_input(path);
  chain.push_back(path);
  for (const char* name : {"/mesh", "/tags"}) {
    const auto link = store.linked(name);
    if (!link) continue;
    const std::string target = resolved_from(path, link->first);
    std::error_code ignored;
    for (const auto& before : chain)
      if (fs::equivalent(before, target, ignored))
        throw Error(path, fmt::format("its link {} leads in a circle, to {}", name, target),
                    "a file it was made from was replaced: make them again");
    walk_in_child(target);
    auto behind = std::make_unique<Impl>();
    behind->path = behind->on_disk = target;
    const Id access = reading();
    behind->file = Id(H5Fopen(target.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
    if (!behind->file.ok()) continue;  // who needs it says what is wrong
    Store next(std::move(behind));
    follow_links(next, chain);
  }
  chain.pop_back();
}

namespace {

/// `sealed`: nobody reads it before it is whole, so it may be of the format whose every block of metadata has a checksum; a file of that
/// format cannot be opened while it is written, nor after a writer that was killed.  Others are written through a journal.
Id create_file(const std::string& path, const std::string& on_disk, bool sealed) {
  start_library();
  const int descriptor = ::open(on_disk.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw Error(path, fmt::format("cannot write: {}", std::strerror(errno)), "", Exit::resources);
  ::close(descriptor);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_alignment(access, 4 * slab_rows, 4 * slab_rows);  // a page
  if (sealed)
    H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  else
    JournalledFile::choose(access);
  const Id creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  Id file(H5Fcreate(on_disk.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
  if (!file.ok()) {
    const Cause cause = last_cause();
    ::unlink(on_disk.c_str());
    throw Error(path, fmt::format("cannot write: {}", cause.error ? std::strerror(cause.error) : cause.text), "", Exit::resources);
  }
  return file;
}

void sync(const std::string& path) {
  if (const int d = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); d >= 0) {
    const bool ok = ::fsync(d) == 0 || errno == EINVAL;
    const int error = errno;
    ::close(d);
    if (!ok) throw Error(path, fmt::format("cannot write: {}", std::strerror(error)), "", Exit::resources);
  }
}

}  // namespace

Store Store::create(const std::string& path) {
  auto impl = std::make_unique<Impl>();
  check_output(path);
  impl->path = followed(path);
  impl->on_disk = fmt::format("{}.tmp-{}", impl->path, ::getpid());
  impl->file = create_file(path, impl->on_disk, true);
  impl->writable = impl->temporary = true;
  return Store(std::move(impl));
}

std::string unpublished(const std::string& path) { return followed(path) + ".new"; }

Store Store::create_growing(const std::string& path) {
  auto impl = std::make_unique<Impl>();
  check_output(path);
  impl->path = followed(path), impl->on_disk = unpublished(impl->path);
  impl->lock_output();
  impl->temporary = true;
  impl->file = create_file(path, impl->on_disk, false);
  impl->growing = &JournalledFile::behind(impl->file);
  impl->writable = true;
  return Store(std::move(impl));
}

Store Store::open_growing(const std::string& path) {
  Store::open(path);  // says what is wrong with it
  auto impl = std::make_unique<Impl>();
  impl->path = impl->on_disk = path;
  impl->lock_output();
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_alignment(access, 4 * slab_rows, 4 * slab_rows);
  JournalledFile::choose(access);
  impl->file = Id(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), H5Fclose);
  if (!impl->file.ok()) impl->fail_write("cannot open");
  impl->growing = &JournalledFile::behind(impl->file);
  impl->writable = impl->grows_on = true;
  release_input(path);
  return Store(std::move(impl));
}

namespace {

/// A descriptor of `path`, locked; -1 where there is no such file; another process has it: Error.
int locked(const std::string& path, const std::string& name, int how) {
  const int file = ::open(path.c_str(), how | O_CLOEXEC, 0666);
  if (file < 0 && errno == ENOENT) return -1;
  if (file < 0) throw Error(name, fmt::format("cannot write: {}", std::strerror(errno)), "", Exit::resources);
  if (::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(file);
    throw Error(name, "another program has it open", "wait until the run that writes it ends, close what reads it, or give another -o",
                Exit::resources);
  }
  return file;  // also where the file system knows no locks
}

bool is_file(int descriptor, const std::string& path) {
  struct stat a {
  }, b{};
  return ::fstat(descriptor, &a) == 0 && ::stat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

}  // namespace

void Store::Impl::lock_output() {
  if (on_disk == path) {
    lock = locked(path, path, O_RDONLY);
    return;
  }
  do {  // whoever had the new file when we opened it may have given it its name since
    if (lock >= 0) ::close(lock);
    lock = locked(on_disk, path, O_RDWR | O_CREAT);
  } while (!is_file(lock, on_disk));
  try {
    if (const int former = locked(path, path, O_RDONLY); former >= 0) ::close(former);
  } catch (...) {
    ::unlink(on_disk.c_str());
    throw;
  }
}

void Store::Impl::commit(bool safe, const std::function<void()>& before) {
  if (!growing->commit(safe)) fail_write("cannot commit");
  if (!temporary) return;
  if (before) before();
  if (!growing->rename(path)) fail_write("cannot rename");
  temporary = false, on_disk = path;
}

void Store::flush(bool safe, const std::function<void()>& before) {
  impl_->drain();
  impl_->need(H5Fflush(impl_->file, H5F_SCOPE_GLOBAL) >= 0, "cannot flush");
  if (impl_->growing) impl_->commit(safe, before);
}

void Store::publish() {
  flush();
  if (impl_->growing) {
    impl_->growing->give_up();  // nothing is left to be written
    impl_->close();
    return;
  }
  impl_->write_digest(impl_->owner("/"), digest_of_attributes(impl_->file), attributes_digest_name);
  if (!impl_->close()) throw Error(impl_->path, "cannot close the file", "", Exit::resources);
  const bool rename = std::exchange(impl_->temporary, false);
  try {
    sync(impl_->on_disk);
    if (rename && ::rename(impl_->on_disk.c_str(), impl_->path.c_str()) != 0)
      throw Error(impl_->path, fmt::format("cannot write: {}", std::strerror(errno)), "", Exit::resources);
  } catch (const Error&) {
    if (rename) ::unlink(impl_->on_disk.c_str());
    throw;
  }
}

}  // namespace hilo
