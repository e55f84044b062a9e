// HDF5 through its C interface.  The library is the Open MPI build, used here with the POSIX driver alone: MPI is never initialised.
#include "model/store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <numeric>

#include "base/error.hpp"

namespace hilo {
namespace fs = std::filesystem;
namespace {

/// An HDF5 handle that closes itself.
class Id {
 public:
  Id() = default;
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Id(Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(id_, other.id_), std::swap(close_, other.close_);
    return *this;
  }
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
  hid_t release() { return std::exchange(id_, -1); }
  bool ok() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

void start_library() {
  static const bool once = [] {
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);  // a growing file may be read while it is written
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  (void)once;
}

/// The system error behind the last failed call (0 if none) and the library's own words.
struct Cause {
  int error = 0;
  std::string text;
};
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

template <class T> hid_t memory_type();
template <> hid_t memory_type<double>() { return H5T_NATIVE_DOUBLE; }
template <> hid_t memory_type<float>() { return H5T_NATIVE_FLOAT; }
template <> hid_t memory_type<std::int32_t>() { return H5T_NATIVE_INT32; }
template <> hid_t memory_type<std::int64_t>() { return H5T_NATIVE_INT64; }
template <> hid_t memory_type<std::uint8_t>() { return H5T_NATIVE_UINT8; }
template <class T> hid_t file_type();
template <> hid_t file_type<double>() { return H5T_IEEE_F64LE; }
template <> hid_t file_type<float>() { return H5T_IEEE_F32LE; }
template <> hid_t file_type<std::int32_t>() { return H5T_STD_I32LE; }
template <> hid_t file_type<std::int64_t>() { return H5T_STD_I64LE; }
template <> hid_t file_type<std::uint8_t>() { return H5T_STD_U8LE; }

Id text_type() {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::int64_t product(std::span<const std::int64_t> shape) {
  return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
}

Id simple_space(std::span<const std::int64_t> shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose};
}

std::vector<std::int64_t> extent(hid_t space) {
  std::vector<hsize_t> dims(std::max(0, H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return {dims.begin(), dims.end()};
}

/// Room that rows are gathered in before they are written [bytes].
constexpr size_t row_buffer = 1 << 16;

/// An array that grows, with the rows not written yet.
struct Rows {
  Id set;
  hid_t type;
  size_t row_bytes;
  std::vector<hsize_t> shape;  // first entry: rows in the file
  std::vector<std::byte> pending;
};

}  // namespace

struct Store::Impl {
  std::string path;     // as the user named it
  std::string on_disk;  // name while it is open
  Id file;
  bool writable = false, temporary = false;
  std::map<std::string, Rows, std::less<>> rows;

  ~Impl() {
    if (!file.ok()) return;
    if (writable && !temporary) {
      try {
        drain();
      } catch (const Error&) {
      }
    }
    const bool remove = temporary;
    if (remove) abandon();
    close();
    if (remove) ::unlink(on_disk.c_str());
  }

  bool close() {
    rows.clear();
    return H5Fclose(file.release()) >= 0;
  }

  /// Send what the library still wants to write nowhere: after a full disk it could not be closed otherwise.
  void abandon() {
    void* handle = nullptr;
    if (H5Fget_vfd_handle(file, H5P_DEFAULT, &handle) < 0 || !handle) return;
    const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    if (nowhere < 0) return;
    ::dup2(nowhere, *static_cast<int*>(handle));
    ::close(nowhere);
  }

  [[noreturn]] void fail_write(const std::string& what) {
    const Cause cause = last_cause();
    if (!cause.error) throw Error(path, fmt::format("{}: {}", what, cause.text), "", Exit::fault);
    abandon();
    if (temporary) ::unlink(on_disk.c_str());
    throw Error(path, fmt::format("cannot write: {}", std::strerror(cause.error)), "", Exit::resources);
  }
  [[noreturn]] void fail_read(const std::string& array) const {
    const Cause cause = last_cause();
    throw Error(path, fmt::format("{} cannot be read: {}", array, cause.text), "damaged or truncated?");
  }
  void need(bool ok, const std::string& what) {
    if (!ok) fail_write(what);
  }

  Id open_array(const std::string& array) const {
    if (!exists(array)) throw Error(path, fmt::format("no array {}", array));
    Id set(H5Dopen2(file, array.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.ok()) fail_read(array);
    return set;
  }

  bool exists(const std::string& object) const {
    if (object == "/") return true;
    for (size_t at = object.find('/', 1);; at = object.find('/', at + 1)) {
      const std::string part = object.substr(0, at);
      if (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0 || H5Oexists_by_name(file, part.c_str(), H5P_DEFAULT) <= 0) return false;
      if (at == std::string::npos) return true;
    }
  }

  Id make_array(const std::string& array, hid_t type, hid_t space, hid_t creation) {
    if (exists(array)) throw Error(path, fmt::format("array {} written twice", array), "", Exit::fault);
    const Id link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(link, 1);
    H5Pset_char_encoding(link, H5T_CSET_UTF8);
    H5Pset_obj_track_times(creation, false);  // the same content gives the same bytes
    Id set(H5Dcreate2(file, array.c_str(), type, space, link, creation, H5P_DEFAULT), H5Dclose);
    need(set.ok(), "cannot create " + array);
    return set;
  }

  void attribute(hid_t object, const std::string& name, hid_t type, hid_t memory, const void* value) {
    if (H5Aexists(object, name.c_str()) > 0) need(H5Adelete(object, name.c_str()) >= 0, "cannot replace attribute " + name);
    const Id space(H5Screate(H5S_SCALAR), H5Sclose);
    const Id made(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    need(made.ok() && H5Awrite(made, memory, value) >= 0, "cannot write attribute " + name);
  }
  void text_attribute(hid_t object, const std::string& name, const std::string& value) {
    const Id type = text_type();
    const char* text = value.c_str();
    attribute(object, name, type, type, &text);
  }
  /// The object an attribute belongs to; a group of that name is made where there is nothing.
  Id owner(const std::string& object) {
    if (exists(object)) return {H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose};
    const Id link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(link, 1);
    Id group(H5Gcreate2(file, object.c_str(), link, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    need(group.ok(), "cannot create group " + object);
    return group;
  }

  void drain(Rows& r, const std::string& array) {
    if (r.pending.empty()) return;
    const hsize_t more = r.pending.size() / r.row_bytes;
    std::vector<hsize_t> start(r.shape.size(), 0), count = r.shape;
    start[0] = r.shape[0], count[0] = more;
    r.shape[0] += more;
    need(H5Dset_extent(r.set, r.shape.data()) >= 0, "cannot extend " + array);
    const Id space(H5Dget_space(r.set), H5Sclose);
    const Id memory(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    need(H5Dwrite(r.set, r.type, memory, space, H5P_DEFAULT, r.pending.data()) >= 0, "cannot write " + array);
    r.pending.clear();
  }
  void drain() {
    for (auto& [array, r] : rows) drain(r, array);
  }
};

Store::Store(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;
Store::~Store() = default;
const std::string& Store::path() const { return impl_->path; }

// ------------------------------------------------------------------------------------------------ opening and closing

Store Store::open(const std::string& path) {
  start_library();
  struct stat status;
  if (::stat(path.c_str(), &status) != 0) {
    if (errno == EACCES) throw Error(path, "cannot read: Permission denied", "", Exit::resources);
    throw Error(path, "no such file");
  }
  if (S_ISDIR(status.st_mode)) throw Error(path, "is a folder, not a file");
  if (::access(path.c_str(), R_OK) != 0) throw Error(path, fmt::format("cannot read: {}", std::strerror(errno)), "", Exit::resources);
  if (status.st_size == 0) throw Error(path, "empty file");
  if (H5Fis_hdf5(path.c_str()) <= 0) throw Error(path, "not an HDF5 file");
  auto impl = std::make_unique<Impl>();
  impl->path = impl->on_disk = path;
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  impl->file = Id(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (!impl->file.ok()) {
    const Cause cause = last_cause();
    const bool cut = cause.text.find("truncated") != std::string::npos || cause.text.find("eof") != std::string::npos;
    throw Error(path, cut ? "truncated file" : fmt::format("truncated or damaged HDF5 file: {}", cause.text));
  }
  return Store(std::move(impl));
}

namespace {

Id create_file(const std::string& path, const std::string& on_disk) {
  start_library();
  // Opened by hand first: the library hides why it could not.
  const int descriptor = ::open(on_disk.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw Error(path, fmt::format("cannot write: {}", std::strerror(errno)), "", Exit::resources);
  ::close(descriptor);
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  Id file(H5Fcreate(on_disk.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
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
  if (fs::is_directory(path)) throw Error(path, "cannot write: is a folder", "", Exit::resources);
  impl->path = path;
  impl->on_disk = fmt::format("{}.tmp-{}", path, ::getpid());
  impl->file = create_file(path, impl->on_disk);
  impl->writable = impl->temporary = true;
  return Store(std::move(impl));
}

Store Store::create_growing(const std::string& path) {
  auto impl = std::make_unique<Impl>();
  if (fs::is_directory(path)) throw Error(path, "cannot write: is a folder", "", Exit::resources);
  if (::unlink(path.c_str()) != 0 && errno != ENOENT)  // whoever still reads the old file keeps it
    throw Error(path, fmt::format("cannot write: {}", std::strerror(errno)), "", Exit::resources);
  impl->path = impl->on_disk = path;
  impl->file = create_file(path, path);
  impl->writable = true;
  return Store(std::move(impl));
}

void Store::flush() {
  impl_->drain();
  impl_->need(H5Fflush(impl_->file, H5F_SCOPE_GLOBAL) >= 0, "cannot flush");
}

void Store::publish() {
  flush();
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

void Store::discard() {
  if (!impl_->file.ok()) return;
  impl_->abandon();
  impl_->close();
  impl_->temporary = false;
  ::unlink(impl_->on_disk.c_str());
}

// --------------------------------------------------------------------------------------------------------------- reading

bool Store::has(const std::string& object) const { return impl_->exists(object); }

std::vector<std::string> Store::list(const std::string& group) const {
  std::vector<std::string> names;
  if (!has(group)) return names;
  const Id g(H5Gopen2(impl_->file, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!g.ok()) return names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Literate(g, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &names) < 0) impl_->fail_read(group);
  std::sort(names.begin(), names.end());
  return names;
}

bool Store::is_array(const std::string& object) const {
  if (!has(object)) return false;
  const Id o(H5Oopen(impl_->file, object.c_str(), H5P_DEFAULT), H5Oclose);
  return o.ok() && H5Iget_type(o) == H5I_DATASET;
}

std::vector<std::int64_t> Store::shape(const std::string& array) const {
  impl_->drain();
  const Id set = impl_->open_array(array);
  const Id space(H5Dget_space(set), H5Sclose);
  return extent(space);
}

std::string Store::type(const std::string& array) const {
  const Id set = impl_->open_array(array);
  const Id t(H5Dget_type(set), H5Tclose);
  const size_t size = H5Tget_size(t);
  switch (H5Tget_class(t)) {
    case H5T_STRING: return "string";
    case H5T_FLOAT: return fmt::format("f{}", size);
    case H5T_INTEGER: return fmt::format("{}{}", H5Tget_sign(t) == H5T_SGN_NONE ? "u" : "i", size);
    default: return "other";
  }
}

template <class T> std::vector<T> Store::read(const std::string& array) const {
  const auto n = shape(array);
  return read_rows<T>(array, 0, n.empty() ? 1 : n[0]);
}

template <class T> std::vector<T> Store::read_rows(const std::string& array, std::int64_t first, std::int64_t count) const {
  impl_->drain();
  const Id set = impl_->open_array(array);
  const Id type(H5Dget_type(set), H5Tclose);
  if (const auto c = H5Tget_class(type); c != H5T_INTEGER && c != H5T_FLOAT) throw Error(impl_->path, fmt::format("{} does not hold numbers", array));
  const Id space(H5Dget_space(set), H5Sclose);
  auto n = extent(space);
  const std::int64_t rows = n.empty() ? 1 : n[0];
  if (first < 0 || count < 0 || first + count > rows)
    throw Error(impl_->path, fmt::format("{} has {} rows, wanted {} to {}", array, rows, first, first + count));
  if (n.empty()) n.push_back(1);
  n[0] = count;
  std::vector<T> values(static_cast<size_t>(product(n)));
  if (values.empty()) return values;
  if (count < rows) {
    std::vector<hsize_t> start(n.size(), 0), size(n.begin(), n.end());
    start[0] = static_cast<hsize_t>(first);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr);
    const Id room = simple_space(n);
    if (H5Dread(set, memory_type<T>(), room, space, H5P_DEFAULT, values.data()) < 0) impl_->fail_read(array);
  } else if (H5Dread(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    impl_->fail_read(array);
  }
  return values;
}

namespace {

/// Strings of an open array or attribute, variable or fixed length.  `get(type, buffer)` reads.
template <class Read> std::optional<std::vector<std::string>> strings_of(hid_t file_type, hid_t space, const Read& get) {
  const auto n = static_cast<size_t>(product(extent(space)));
  std::vector<std::string> texts(n);
  if (n == 0) return texts;
  if (H5Tis_variable_str(file_type) > 0) {
    Id type(H5Tcopy(file_type), H5Tclose);
    std::vector<char*> raw(n, nullptr);
    if (get(type, raw.data()) < 0) return std::nullopt;
    for (size_t i = 0; i < n; ++i) texts[i] = raw[i] ? raw[i] : "";
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw.data());
  } else {
    const size_t size = H5Tget_size(file_type);
    std::vector<char> raw(n * size);
    if (get(file_type, raw.data()) < 0) return std::nullopt;
    for (size_t i = 0; i < n; ++i) texts[i] = std::string(raw.data() + i * size, strnlen(raw.data() + i * size, size));
  }
  return texts;
}

}  // namespace

std::vector<std::string> Store::read_strings(const std::string& array) const {
  const Id set = impl_->open_array(array);
  const Id type(H5Dget_type(set), H5Tclose), space(H5Dget_space(set), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING) throw Error(impl_->path, fmt::format("{} does not hold text", array));
  auto texts = strings_of(type, space, [&](hid_t t, void* to) { return H5Dread(set, t, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); });
  if (!texts) impl_->fail_read(array);
  return *texts;
}

std::string Store::read_text(const std::string& array) const {
  const auto texts = read_strings(array);
  if (texts.size() != 1) throw Error(impl_->path, fmt::format("{} holds {} texts, not one", array, texts.size()));
  return texts[0];
}

std::optional<std::string> Store::text_attribute(const std::string& object, const std::string& name) const {
  if (!has(object) || H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
  const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Id type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  if (!a.ok() || H5Tget_class(type) != H5T_STRING) return std::nullopt;
  const auto texts = strings_of(type, space, [&](hid_t t, void* to) { return H5Aread(a, t, to); });
  return texts && texts->size() == 1 ? std::optional(texts->front()) : std::nullopt;
}

std::optional<double> Store::number_attribute(const std::string& object, const std::string& name) const {
  if (!has(object) || H5Aexists_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return std::nullopt;
  const Id a(H5Aopen_by_name(impl_->file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const Id type(H5Aget_type(a), H5Tclose), space(H5Aget_space(a), H5Sclose);
  if (!a.ok() || H5Tget_class(type) == H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) return std::nullopt;
  double value;
  return H5Aread(a, H5T_NATIVE_DOUBLE, &value) < 0 ? std::nullopt : std::optional(value);
}

// --------------------------------------------------------------------------------------------------------------- writing

template <class T>
void Store::write(const std::string& array, std::span<const T> values, std::vector<std::int64_t> shape, const std::string& unit,
                  const std::string& meaning) {
  if (product(shape) != static_cast<std::int64_t>(values.size()))
    throw Error(impl_->path, fmt::format("{}: {} values for {} places", array, values.size(), product(shape)), "", Exit::fault);
  const Id space = simple_space(shape), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  const Id set = impl_->make_array(array, file_type<T>(), space, creation);
  if (!values.empty())
    impl_->need(H5Dwrite(set, memory_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, "cannot write " + array);
  if (!unit.empty()) impl_->text_attribute(set, "unit", unit);
  if (!meaning.empty()) impl_->text_attribute(set, "meaning", meaning);
}

void Store::write_strings(const std::string& array, std::span<const std::string> values) {
  const std::vector<std::int64_t> shape{static_cast<std::int64_t>(values.size())};
  const Id type = text_type(), space = simple_space(shape), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Id set = impl_->make_array(array, type, space, creation);
  std::vector<const char*> raw;
  for (const auto& v : values) raw.push_back(v.c_str());
  if (!raw.empty()) impl_->need(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, raw.data()) >= 0, "cannot write " + array);
}

void Store::write_text(const std::string& array, const std::string& text) {
  const Id type = text_type(), space = simple_space({}), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Id set = impl_->make_array(array, type, space, creation);
  const char* raw = text.c_str();
  impl_->need(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &raw) >= 0, "cannot write " + array);
}

template <class T>
void Store::start_rows(const std::string& array, std::vector<std::int64_t> row_shape, const std::string& unit, const std::string& meaning,
                       const std::string& time) {
  const size_t row_bytes = static_cast<size_t>(product(row_shape)) * sizeof(T);
  std::vector<hsize_t> now{0}, most{H5S_UNLIMITED}, chunk{std::clamp<hsize_t>(row_buffer / 4 / std::max<size_t>(1, row_bytes), 1, 1024)};
  for (const auto n : row_shape) {
    now.push_back(static_cast<hsize_t>(n)), most.push_back(static_cast<hsize_t>(n));
    chunk.push_back(std::max<hsize_t>(1, static_cast<hsize_t>(n)));
  }
  const Id space(H5Screate_simple(static_cast<int>(now.size()), now.data(), most.data()), H5Sclose);
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
  Id set = impl_->make_array(array, file_type<T>(), space, creation);
  if (!unit.empty()) impl_->text_attribute(set, "unit", unit);
  if (!meaning.empty()) impl_->text_attribute(set, "meaning", meaning);
  if (!time.empty()) impl_->text_attribute(set, "time", time);
  impl_->rows.emplace(array, Rows{std::move(set), memory_type<T>(), row_bytes, std::move(now), {}});
}

template <class T> void Store::append(const std::string& array, std::span<const T> row) {
  const auto found = impl_->rows.find(array);
  if (found == impl_->rows.end() || row.size_bytes() != found->second.row_bytes || found->second.type != memory_type<T>())
    throw Error(impl_->path, fmt::format("{}: a row of {} values of {} bytes does not fit", array, row.size(), sizeof(T)), "", Exit::fault);
  auto& r = found->second;
  const auto bytes = std::as_bytes(row);
  r.pending.insert(r.pending.end(), bytes.begin(), bytes.end());
  if (r.pending.size() >= row_buffer) impl_->drain(r, array);
}

void Store::set(const std::string& object, const std::string& attribute, const std::string& value) {
  const Id o = impl_->owner(object);
  impl_->text_attribute(o, attribute, value);
}
void Store::set(const std::string& object, const std::string& attribute, double value) {
  const Id o = impl_->owner(object);
  impl_->attribute(o, attribute, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}
void Store::set(const std::string& object, const std::string& attribute, std::int64_t value) {
  const Id o = impl_->owner(object);
  impl_->attribute(o, attribute, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

// ----------------------------------------------------------------------------------------------------------------- links

void Store::link(const std::string& name, const std::string& target, const std::string& object) {
  const std::string relative = relative_to(impl_->path, target);
  const Id creation(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(creation, 1);
  impl_->need(H5Lcreate_external(relative.c_str(), object.c_str(), impl_->file, name.c_str(), creation, H5P_DEFAULT) >= 0,
              "cannot link " + name);
}

std::optional<std::pair<std::string, std::string>> Store::linked(const std::string& name) const {
  H5L_info_t what;
  if (H5Lexists(impl_->file, name.c_str(), H5P_DEFAULT) <= 0 || H5Lget_info(impl_->file, name.c_str(), &what, H5P_DEFAULT) < 0 ||
      what.type != H5L_TYPE_EXTERNAL)
    return std::nullopt;
  std::vector<char> value(what.u.val_size);
  const char *file = nullptr, *object = nullptr;
  if (H5Lget_val(impl_->file, name.c_str(), value.data(), value.size(), H5P_DEFAULT) < 0 ||
      H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0)
    impl_->fail_read(name);
  return std::pair{std::string(file), std::string(object)};
}

#define HILO_STORE_TYPE(T)                                                                                                                    \
  template std::vector<T> Store::read<T>(const std::string&) const;                                                                           \
  template std::vector<T> Store::read_rows<T>(const std::string&, std::int64_t, std::int64_t) const;                                          \
  template void Store::write<T>(const std::string&, std::span<const T>, std::vector<std::int64_t>, const std::string&, const std::string&);   \
  template void Store::start_rows<T>(const std::string&, std::vector<std::int64_t>, const std::string&, const std::string&, const std::string&); \
  template void Store::append<T>(const std::string&, std::span<const T>);
HILO_STORE_TYPE(double)
HILO_STORE_TYPE(float)
HILO_STORE_TYPE(std::int32_t)
HILO_STORE_TYPE(std::int64_t)
HILO_STORE_TYPE(std::uint8_t)
#undef HILO_STORE_TYPE

}  // namespace hilo
