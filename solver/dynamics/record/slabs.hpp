// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of an output array shared out over the ranks in runs of consecutive rows: each rank writes one piece of the file, none holds it all.
#pragma once
#include "base/comm.hpp"
#include "model/store.hpp"

namespace hilo {

class Slabs {
 public:
  /// `row` of each local item (a node, a cell) in the file, -1 for what is not written or what another rank sends.  Collective.
  Slabs(const Comm& comm, std::vector<std::int64_t> row, std::int64_t n_rows);

  std::int64_t n_rows() const { return n_; }
  std::int64_t first() const { return first_; }  // of this rank's piece
  std::int64_t count() const { return count_; }
  int rank_of(std::int64_t row) const { return static_cast<int>(row / most_); }

  /// This rank's piece (count x width) of values of the local items (n x width); 0 where no item has the row.  Collective.
  std::vector<double> collect(const std::vector<double>& local, int width) const;

  /// Write an array of which every rank has its piece.  `f`: the file on the rank that holds it open, else null.  Errors are this rank's
  /// own.  Collective.
  template <class T>
  void write(Store* f, const std::string& path, const std::string& array, const std::vector<double>& piece, int width,
             const std::string& unit, const std::string& meaning = "") const;

 private:
  const Comm* comm_;
  std::vector<std::int64_t> row_;
  std::int64_t n_, most_, first_, count_;  // most_: rows of a piece but the last
};

}  // namespace hilo
