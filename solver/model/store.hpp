// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files: arrays with units, strings, histories that grow, links, and publication as a whole or not at all.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hilo {

/// One open HDF5 file.  Element types: double, float, int32, int64, uint8.  Every failure throws Error: exit 2 for a file that cannot be
/// understood, 4 for no space or no permission.
class Store {
 public:
  /// Read only.  A missing, foreign or truncated file is an Error that says which.
  static Store open(const std::string& path);
  /// A new file, written as `path`.tmp until publish() renames it; left unpublished it is removed on destruction.
  static Store create(const std::string& path);
  /// A new file that readers may open while it grows (results).  Until the first flush() it is `path`.new, then it replaces what was at
  /// `path`; whatever happens after a flush, it stays as that left it.  Locked: Error (exit 4) where another process writes to `path`.
  static Store create_growing(const std::string& path);
  /// Such a file, to grow on: arrays that are started are those it has.
  static Store open_growing(const std::string& path);
  Store(Store&&) noexcept;
  Store& operator=(Store&&) noexcept;
  ~Store();

  bool has(const std::string& object) const;
  std::vector<std::string> list(const std::string& group) const;  // names in a group, sorted; empty when there is no such group
  std::vector<std::int64_t> shape(const std::string& array) const;
  bool is_array(const std::string& object) const;    // false for a group, and where there is nothing
  std::string type(const std::string& array) const;  // as the schema writes it: f8, i8, i4, u1, string

  template <class T>
  std::vector<T> read(const std::string& array) const;
  /// Rows [first, first + count) of the first axis.
  template <class T>
  std::vector<T> read_rows(const std::string& array, std::int64_t first, std::int64_t count) const;
  std::vector<std::string> read_strings(const std::string& array) const;
  std::string read_text(const std::string& array) const;  // a scalar string

  /// Write an array of shape `shape` (rows first); `unit` and `meaning` become attributes.
  template <class T>
  void write(const std::string& array, std::span<const T> values, std::vector<std::int64_t> shape, const std::string& unit = "",
             const std::string& meaning = "");
  void write_strings(const std::string& array, std::span<const std::string> values);
  void write_text(const std::string& array, const std::string& text);

  /// Room for an array that several ranks fill by write_at(): its first byte in the file, -1 for an empty one.
  template <class T>
  std::int64_t reserve(const std::string& array, std::vector<std::int64_t> shape, const std::string& unit = "",
                       const std::string& meaning = "");
  /// An array that grows along its first axis; append() adds rows.
  template <class T>
  void start_rows(const std::string& array, std::vector<std::int64_t> row_shape, const std::string& unit = "",
                  const std::string& meaning = "", const std::string& time = "");
  template <class T>
  void append(const std::string& array, std::span<const T> rows);
  /// Are the arrays of this group members of a table?
  bool is_table(const std::string& group) const;
  /// Many growing arrays of `width` columns as one, which costs far less: each is read as GROUP/MEMBER, as if it were apart.  `members`:
  /// their names as links.  append_table() adds a row of all of them.
  template <class T>
  void start_table(const std::string& group, const std::vector<std::string>& members, std::int64_t width, const std::string& unit = "",
                   const std::string& meaning = "", const std::string& time = "");
  template <class T>
  void append_table(const std::string& group, std::span<const T> row);
  /// A growing array, or table of this group, keeps its first rows alone.
  void keep_rows(const std::string& name, std::int64_t count);
  /// Without this array or group.
  void remove(const std::string& object);
  /// Arrays of this file, one after the other along their first axis, seen as one that takes no room; of a part "" the rows are NaN.  Parts
  /// are alike in shape.
  void write_view(const std::string& array, const std::vector<std::string>& parts);
  /// One more name of an array.
  void name_also(const std::string& array, const std::string& name);

  void set(const std::string& object, const std::string& attribute, const std::string& value);
  void set(const std::string& object, const std::string& attribute, double value);
  void set(const std::string& object, const std::string& attribute, std::int64_t value);
  void set(const std::string& object, const std::string& attribute, std::span<const std::int64_t> values);
  /// Text of fixed length, as some readers want it.
  void set_ascii(const std::string& object, const std::string& attribute, const std::string& value);
  std::optional<std::string> text_attribute(const std::string& object, const std::string& attribute) const;
  std::optional<double> number_attribute(const std::string& object, const std::string& attribute) const;

  /// External link `name` -> `object` of file `target`; the stored path is relative to this file's folder.
  void link(const std::string& name, const std::string& target, const std::string& object);
  /// File and object a link points to, or nothing when `name` is no external link.
  std::optional<std::pair<std::string, std::string>> linked(const std::string& name) const;

  /// What was written survives a killed run, and where `safe` a power cut; a growing file has its name, which it takes after `before`.
  void flush(bool safe = true, const std::function<void()>& before = {});
  void publish();  // flush, fsync, rename to the final name, close
  const std::string& path() const;

  struct Impl;

 private:
  explicit Store(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Name of a growing file until its first flush.
std::string unpublished(const std::string& path);
/// Bytes at their place in a file that another process holds open as a Store; Error (exit 4) where the disk is full.
void write_at(const std::string& path, std::int64_t place, std::span<const std::byte> bytes);
/// Rows whose bytes are whole pages of the file, whatever the type: pieces of a reserved array that begin at multiples share no page.
inline constexpr std::int64_t slab_rows = 1024;

/// Names as HDF5 can hold them: '/' and '%' become %2F and %25, a lone "." %2E.  from_link_name is the inverse.
std::string to_link_name(const std::string& name);
std::string from_link_name(const std::string& link);
/// Path of `file` as seen from the folder of `from`, and back: what a relative link stores and means.
std::string relative_to(const std::string& from, const std::string& file);
std::string resolved_from(const std::string& from, const std::string& relative);
/// Content digest of a file, "fnv1a64:<16 hex digits>".
std::string digest(const std::string& path);
/// Error (exit 4) where a folder, device or pipe is in the place of a file to be written: a rename would replace it.
void refuse_special(const std::string& path);
/// Write a text file as a whole or not at all (temporary file, rename).
void write_text_file(const std::string& path, const std::string& text);
/// A whole text file; Error (exit 2) when it cannot be read.
std::string read_text_file(const std::string& path, const std::string& where = "");
/// This process's command line, quoted for a shell.
std::string command_line(int argc, char** argv);

}  // namespace hilo
