// SPDX-License-Identifier: GPL-3.0-or-later
// A file that HDF5 writes through and that is whole at every instant: a process that is killed, a disk that is full, a power cut leave it
// as it was at the last commit().
//
// What lies behind the committed end is written at once: nothing refers to it yet.  What would overwrite committed bytes is held in memory.
// commit() makes the new bytes safe, writes the held ones as a journal beside the file (path.journal, with a digest at its end), makes that
// safe, then puts them in their places and removes the journal.  A journal that is found whole is put in place by the next who opens the
// file; one that is not was cut off before anything of it was in place, and is dropped (a redo log, as databases have it).
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace hilo {

class JournalledFile {
 public:
  /// Makes H5Fcreate and H5Fopen with this list (hid_t) of access properties write through such a file.
  static void choose(std::int64_t access);
  /// The one behind an open file of HDF5.
  static JournalledFile& behind(std::int64_t file);
  /// What a killed process left half-committed is put in its place.  Error (exit 4) where it cannot be written.
  static void recover(const std::string& path);

  /// A commit of it is under way, or was cut off.
  static bool in_commit(const std::string& path);

  JournalledFile(std::string path, int descriptor);
  ~JournalledFile();
  JournalledFile(const JournalledFile&) = delete;
  JournalledFile& operator=(const JournalledFile&) = delete;

  /// All that HDF5 has flushed becomes the content of the file.  False, and error(), where that failed: the file is as it was.  `safe`: a
  /// power cut leaves it so too; without it, which takes no milliseconds of the disk, the end of the process does.
  bool commit(bool safe = true);
  /// The same file under another name, whatever had it.  False, and error(), where that failed.
  bool rename(const std::string& to);
  /// Nothing more is written: the file stays as it was committed last.
  void give_up() { lost_ = true; }
  /// errno of the first write that failed, 0: none did.
  int error() const { return error_; }

  // what HDF5 asks of a file
  bool read(std::uint64_t at, std::span<std::byte> to);
  bool write(std::uint64_t at, std::span<const std::byte> from);
  std::uint64_t allocated = 0;  // end of what HDF5 has given out
  std::uint64_t end() const { return end_; }
  void end_at(std::uint64_t at) {
    if (!lost_) end_ = at;
  }
  int descriptor() const { return descriptor_; }

 private:
  bool fail();
  std::string path_;
  int descriptor_;
  std::uint64_t end_ = 0, committed_ = 0;
  std::map<std::uint64_t, std::vector<std::byte>> held_;  // pieces of the committed part, apart from each other
  int error_ = 0;
  bool lost_ = false;  // what is written goes nowhere
};

}  // namespace hilo
