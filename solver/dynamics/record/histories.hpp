// SPDX-License-Identifier: GPL-3.0-or-later
// Histories: a row at every step of all that the run and the contributions put out.
#pragma once
#include "dynamics/audit.hpp"
#include "dynamics/state.hpp"
#include "model/store.hpp"
#include "system/system.hpp"

namespace hilo {

class Histories {
 public:
  explicit Histories(const System& system);
  /// Numbers of a row that belong to an instant, and those that belong inside the step before it.
  struct Numbers {
    std::vector<double> end, mid;
  };
  /// What observers see at the end of a step, or before the first one (`step` null); once for each.  Collective.
  Numbers numbers(double t, const Config& q, const Config& v, const Ledger& ledger, const Moment* step) const;
  size_t n_mid() const { return n_mid_; }
  /// `mid` is continued from the middles of steps, the nearest first, to the outer end of the first one.  What only presses may begin or
  /// end there: where it falls by more than half, or was open in one of the steps, it has the value of the nearest one.
  void hold(std::vector<double>& mid, std::span<const std::vector<double>* const> all) const;
  /// The arrays, without rows.
  void declare(Store& f);
  /// Those of a file that goes on after so many rows, and no more of them.  A file that lacks some is an error, and stays as it was.
  void go_on(Store& f, std::int64_t n_rows);
  /// A row; `mid` as interpolated to its instant.
  void append(Store& f, double t, int newton, const std::vector<double>& end, const std::vector<double>& mid) const;

 private:
  /// A table of a file of before there were any: its members are arrays of their own.
  void take_apart(size_t table);

  const System& system_;
  std::vector<Output> outputs_;      // of the run, then of the contributions
  std::vector<std::string> arrays_;  // their paths; empty where they are in a table
  struct Table {
    std::string group;
    std::vector<std::string> members;  // as links
    size_t width = 0;                  // columns of each
  };
  std::vector<Table> tables_;
  std::vector<int> table_of_;  // of each output, or -1
  size_t n_mid_ = 0;
};

}  // namespace hilo
