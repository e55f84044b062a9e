// SPDX-License-Identifier: GPL-3.0-or-later
// Columns of the histories of a run, by name, by glob, or by formula over other columns; `F` and `M` are resultants of Fx, Fy, Fz and of
// Mx, My, Mz.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "post/run/run_file.hpp"

namespace hilo {

/// One column over the times of its history.
struct Column {
  std::string label, unit;       // "joint.trunnion.Fx", "N"
  std::vector<double> t, value;  // [s], [unit]
};

class RunColumns {
 public:
  /// `lets` are formulas "name = ..." whose names serve in those behind them.
  RunColumns(const RunFile& run, const std::vector<std::string>& lets);
  /// Columns in the order they are asked for, each once: "energy", "joint.*.Fx", or "thrust [kN] = joint.liner.Fx/1e3".  Error with a
  /// suggestion for a name that the run does not have.
  std::vector<Column> pick(const std::vector<std::string>& wanted);
  /// A single one.
  Column one(const std::string& wanted);

 private:
  const Series& history(const std::string& name);
  const Series& described(const std::string& name);
  Column column(const std::string& history_name, const Series& what, size_t c);
  Column resultant(const std::string& history_name, const Series& what, const std::string& of, size_t first);
  Column formula(const std::string& text);
  Column named(const std::string& name);

  const RunFile& run_;
  const std::vector<std::string> known_;
  std::map<std::string, Series> read_, described_;
  std::map<std::string, Column> let_;
};

}  // namespace hilo
