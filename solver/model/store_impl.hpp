// SPDX-License-Identifier: GPL-3.0-or-later
// Inside of Store: handles of the HDF5 library that close themselves, and what an open file remembers.
#pragma once
#define H5_USE_110_API  // what all libraries from 1.10 on share, such as H5Ovisit of five arguments
#include <hdf5.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "base/error.hpp"
#include "model/journalled_file.hpp"
#include "model/store.hpp"

namespace hilo {

/// What a symbolic link names, through others; another path as it is.  Files are written there, and the link stays.
std::string followed(const std::string& path);

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

/// Once per process: no error texts of the library's own, no file locks.
void start_library();

/// The system error behind the last failed call (0 if none) and the library's own words.
struct Cause {
  int error = 0;
  std::string text;
};
Cause last_cause();

/// What a file is to readers while another process may write to it.
struct FileState {
  std::tuple<dev_t, ino_t> file{};
  std::tuple<off_t, time_t, long> content{};
  bool in_commit = false;  // what belongs together is being put in place
  bool is_young = true;    // so recent that one more write would leave its time as it is
  /// Has nothing been written since?
  bool lasts(const FileState& now) const {
    return !is_young && !in_commit && std::tie(file, content, in_commit) == std::tie(now.file, now.content, now.in_commit);
  }
};
FileState state_of(const std::string& path);
/// The same after the commit that is under way, where there is one.
FileState settled(const std::string& path);

/// What `read(state)` returns, made again where the file changed meanwhile, a bounded number of times: HDF5 reads what describes arrays
/// piece by piece, and pieces of two commits do not fit, which looks like damage or like zeros.
template <class Read>
auto while_it_grows(const std::string& path, Read&& read) {
  constexpr int most = 20, most_of_success = 3;  // what went well is nearly always right: bytes were appended
  for (int attempt = 1;; ++attempt) {
    const FileState before = settled(path);
    try {
      auto result = read(before);
      if (attempt >= most_of_success || before.lasts(state_of(path))) return result;
    } catch (const Error&) {
      if (attempt >= most || before.lasts(state_of(path))) throw;
    }
    ::usleep(static_cast<useconds_t>(5000 * attempt));
  }
}

/// Error where the library does not survive a walk through the file.
void walk_in_child(const std::string& path);
/// Of names and attributes of all objects: a sealed file has it as attribute `attributes_digest_name` of its root.
std::uint64_t digest_of_attributes(hid_t file);

/// Digest of texts: lengths and letters, one after the other.
std::uint64_t digest_of(std::span<const std::string> texts);

/// Digest of an array's bytes as they lie in the file: its attribute of this name.
inline constexpr const char *digest_name = "fnv1a64", *attributes_digest_name = "attributes_fnv1a64";

/// Type of T in memory and, little-endian, in the file.
template <class T>
hid_t memory_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}
template <class T>
hid_t file_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::is_same_v<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_STD_I32LE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_STD_I64LE;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_STD_U8LE;
}

inline Id text_type() {
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

/// How texts are read and written: converted in a buffer of 4 kB, not the megabyte that the library would clear each time.
inline Id text_transfer() {
  Id transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_buffer(transfer, 4096, nullptr, nullptr);
  return transfer;
}

inline std::int64_t product(std::span<const std::int64_t> shape) {
  return std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>());
}

inline Id simple_space(std::span<const std::int64_t> shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  const std::vector<hsize_t> dims(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), H5Sclose};
}

inline std::vector<std::int64_t> extent(hid_t space) {
  std::vector<hsize_t> dims(std::max(0, H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return {dims.begin(), dims.end()};
}

/// Room that rows of an array are gathered in before they are written, and those of all arrays [bytes].
inline constexpr size_t row_buffer = 1 << 16, all_row_buffers = 1 << 26;

/// Arrays of rows that stay open: each holds 15 kB, and twice the time that opening it again takes.
inline constexpr size_t most_open = 1000;

/// Where the members of a table are, in their group: names as users give them are never written so.
inline constexpr const char *table_link = "/%table", *names_link = "/%names";

/// An array that grows, with the rows not written yet.
struct Rows {
  Id set;  // where it stays open
  hid_t type;
  size_t row_bytes, room;      // of a row, and of those that are gathered
  std::vector<hsize_t> shape;  // first entry: rows in the file
  std::vector<std::byte> pending;
};

struct Store::Impl {
  std::string path;     // as the user named it
  std::string on_disk;  // name while it is open
  Id file;
  bool writable = false, temporary = false;
  JournalledFile* growing = nullptr;  // where the file is written through one
  bool grows_on = false;              // it was there before: what is written again replaces what was
  int lock = -1;                      // descriptor that tells others of it
  FileState opened{};                 // that is read
  bool in_read = false;
  std::unordered_map<std::string, Rows> rows;
  size_t pending_bytes = 0;  // of all rows
  struct Names {
    std::vector<std::string> list;  // as links
    std::unordered_map<std::string, std::int64_t> place;
  };
  std::unordered_map<std::string, Names> names;  // of the tables that were asked for, by group

  ~Impl();

  bool close();

  /// After a failed write: what the library still wants to write goes nowhere.
  void abandon();

  /// Lock the output `path` for this process, by the file that is to become it.
  void lock_output();
  /// Commit, and take the name the user gave after `before`.
  void commit(bool safe, const std::function<void()>& before);

  /// Reads of a file that another process may write to.
  template <class Read>
  auto steadily(Read&& read) {
    if (writable || in_read) return read();
    struct Reading {
      bool& flag;
      ~Reading() { flag = false; }
    } reading{in_read};
    in_read = true;
    return while_it_grows(path, [&](const FileState& now) {
      if (now.file == opened.file && (!opened.lasts(now) || !file.ok())) reopen(now);
      return read();
    });
  }
  /// All that are open to read: the library shares what it knows of a file among them, and with a child.
  static std::set<Impl*> readers;
  /// Closes those that have seen another state of the file; each opens it again when it reads.
  static void forget_other_states(const FileState& now);
  void open_to_read();
  void reopen(const FileState& now);

  static void follow_links(Store& store, std::vector<std::string>& chain);

  [[noreturn]] void fail_write(const std::string& what);
  [[noreturn]] void fail_read(const std::string& array) const;
  void need(bool ok, const std::string& what) {
    if (!ok) fail_write(what);
  }

  Id open_array(const std::string& array) const;
  std::vector<std::string> strings(const std::string& array) const;
  /// Error where an array says that it is larger than its file.
  void check_room(hid_t array, const std::string& name, std::int64_t elements, size_t bytes) const;
  /// Error where an array has a digest, and not that of `bytes`.
  void check_digest(hid_t array, const std::string& name, std::uint64_t digest) const;

  bool exists(const std::string& object) const;
  /// Members of the table of a group, or null where it has none.
  const Names* table_names(const std::string& group);
  /// The table that an array is a member of, and its place; nothing where it is an array of its own, or there is none.
  std::optional<std::pair<std::string, std::int64_t>> member(const std::string& array);

  /// The groups above an object, made where there are none.
  void make_groups(const std::string& object);
  Id make_group(const std::string& group);
  Id make_array(const std::string& array, hid_t type, hid_t space, hid_t creation, hid_t access = H5P_DEFAULT);

  void attribute(hid_t object, const std::string& name, hid_t type, hid_t memory, const void* value,
                 std::span<const std::int64_t> shape = {});
  void text_attribute(hid_t object, const std::string& name, const std::string& value);
  /// The object an attribute belongs to; a group of that name is made where there is nothing.
  Id owner(const std::string& object);

  void write_digest(hid_t object, std::uint64_t digest, const char* name = digest_name) {
    attribute(object, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &digest);
  }

  /// An array of rows that is open, or opened now.
  hid_t opened_rows(const Rows& r, const std::string& array, Id& opened);
  void drain(Rows& r, const std::string& array);
  void drain() {
    for (auto& [array, r] : rows) drain(r, array);
  }
};

}  // namespace hilo
