// SPDX-License-Identifier: GPL-3.0-or-later
// Results: histories at every step, fields at intervals, each at its own time and second order.
//
// Mid-step values (accelerations, reactions of energy-momentum) become values at t_n by linear interpolation between the two mid-points
// around it, a_n = (h_n a_{n+1/2} + h_{n+1} a_{n-1/2})/(h_n + h_{n+1}); at the ends and where a load jumps, by extrapolation from one side.
#pragma once
#include <cmath>
#include <deque>
#include <optional>

#include "dynamics/record/histories.hpp"
#include "dynamics/record/mesh_part.hpp"
#include "dynamics/redundancy/minimum_norm.hpp"
#include "system/solids.hpp"

namespace hilo {

class Recorder {
 public:
  struct Setup {
    std::string path;       // run.h5
    double interval = 0;    // between fields [s]
    double end = HUGE_VAL;  // of the run [s], which has fields too
    std::vector<std::string> fields;
    bool single_precision = false;
    bool skin = false;          // fields of the nodes on the surfaces of regions alone
    bool envelope = false;      // the largest values over all steps
    std::vector<double> jumps;  // times at which forces or velocities jump
    std::vector<std::string> provenance;
    bool redundant = false;  // reactions by minimum norm
    double own_time = 0.5;   // where in the step mid values belong
    bool alternates = true;  // whether they alternate about the true ones
    bool is_smooth = false;  // whether they are smooth from step to step: nothing vibrates between steps or hits
    bool is_static = false;
  };
  Recorder(const System& system, const Scene& scene, Setup setup);
  /// The state before the first step, and the stage with its multipliers where they are known there.
  void first(const State& s, const Ledger& ledger, const Stage* there = nullptr, std::span<const double> lambda = {});
  /// Rows not written yet, and how far the file is, between two steps; kept: all of them are safe in the file.  Restored: the file that is
  /// there grows on from these rows, without what it has behind them.
  void archive(Archive& a);
  /// A finished step: the new state and its account, the last stage for reactions, accelerations and Newton iterations; `v`: velocities to
  /// show where they are not those of the state.
  void step(const State& s, const Ledger& ledger, const Taken& taken, const Config& a, int iterations, const Config* v = nullptr);
  /// Last values; publishes the files.  `complete` is false for a run stopped by physics.
  void finish(bool complete);
  /// The run fails: what was written stays, unless that is nothing.
  void give_up();

 private:
  struct Row {  // an instant t_n
    double t = 0;
    std::vector<double> point;                       // values that belong to t_n
    bool jump = false, field = false, last = false;  // last: it has fields as the end of the run alone
    Config q, v;  // kept where a field is due or an envelope looks on, and what the cells remember, by batch
    CellMemory memory;
    int newton = 0;
  };
  struct Interval {  // what belongs to the inside of a step
    double h = 0;
    std::vector<double> mid;
    Config a;
    bool starts_at_jump = false;
  };
  void open(bool again);
  void commit(RunOutput::When when);
  void declare_run(Store& f, const std::vector<double>& resolved) const;
  void declare_bodies(Store& f) const;
  bool is_jump(double t) const;
  void advance(bool last);
  /// Steps that an extrapolation takes.
  size_t n_extrapolated() const { return size_t{2} + setup_.alternates + setup_.is_smooth; }
  std::vector<std::pair<double, const Interval*>> extrapolated(const std::vector<const Interval*>& m, bool from_right) const;
  void write_row(const std::vector<std::pair<double, const Interval*>>& weights);

  const System& system_;
  const Scene& scene_;
  Setup setup_;
  std::optional<MinimumNorm> share_;  // of redundant joints
  RunOutput file_;
  Histories histories_;
  std::optional<MeshPart> mesh_;  // where the scene has a mesh
  std::deque<Row> rows_;
  std::deque<Interval> intervals_;  // interval k starts at row k of rows_
  std::optional<Interval> there_;   // what is known at the first row
  std::deque<Interval> past_;       // the intervals before intervals_[0], for the last row
  std::int64_t n_written_ = 0;      // rows in the file
  double last_t_ = 0, next_field_ = 0;
};

}  // namespace hilo
