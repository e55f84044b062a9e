// SPDX-License-Identifier: GPL-3.0-or-later
// The results file: open on one rank, written by all, each array as the schema has it (model/schema: unit and meaning).
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/record/slabs.hpp"
#include "model/schema.hpp"
#include "model/store.hpp"

namespace hilo {

/// Path without its .h5.
std::string stem(const std::string& path);

/// A whole array.
template <class T>
void write_array(Store& f, const std::string& path, const std::vector<T>& values, std::vector<std::int64_t> shape) {
  const ArraySchema& of = run_array(path);
  f.write<T>(path, values, std::move(shape), std::string(of.unit), std::string(of.meaning));
}
/// One that grows by rows; `time`: the array that has their times; `width`: of a row where the schema has a word for it.
template <class T>
void start_array(Store& f, const std::string& path, const std::string& time = "", int width = 0) {
  const ArraySchema& of = run_array(path);
  auto shape = row_shape(of);
  if (shape.size() == 1 && shape[0] == 0) shape[0] = width;
  f.start_rows<T>(path, std::move(shape), std::string(of.unit), std::string(of.meaning), time);
}

/// Written in place, whole at every instant: until its first commit under another name, so that the former results stay while there is
/// nothing to replace them (model/journalled_file).
class RunOutput {
 public:
  RunOutput(const Comm& comm, std::string path, bool single_precision)
      : comm_(comm), path_(std::move(path)), single_precision_(single_precision) {}
  const std::string& path() const { return path_; }
  /// How fields are stored: "F4" or "F8".
  const char* number() const { return single_precision_ ? "F4" : "F8"; }
  /// A new file, or the one that is there without what `shorten` takes from it.  Collective.
  void create();
  void open(const std::function<void(Store&)>& shorten);
  /// What a rank alone does and may fail at (a full disk) is noted here and told to all ranks by share_failure.
  void on_store(const std::function<void(Store&)>& write);
  void share_failure() const;
  /// An array of which every rank has its piece, in the precision of fields unless `exact`.  Collective.
  void write_piece(const Slabs& rows, const std::string& array, const std::vector<double>& piece, bool exact = false);
  /// Now and then, the first time at once, or now: what was written outlives the process (and a power cut, where the run is not a
  /// short one), and the file has its name; whether this was done on this rank.
  /// Every rank calls it at the same place, behind share_failure().
  enum class When { now_and_then, now, now_safe };
  bool commit(When when);
  /// Checkpoints beside the file are of this run from now on, and stay when it takes the place of a former file.
  void keep_checkpoints() { has_checkpoint_ = true; }
  /// Nothing more is written.
  void close() { store_.reset(); }

 private:
  const Comm& comm_;
  std::string path_;
  bool single_precision_;
  std::unique_ptr<Store> store_;                    // rank 0
  bool has_name_ = false;                           // its own, not that of an unpublished one
  bool has_checkpoint_ = false;                     // those beside it are of this run
  double opened_ = wall_clock(), next_commit_ = 0;  // [s]
  std::optional<Error> failure_;                    // of a write of this rank
};

}  // namespace hilo
