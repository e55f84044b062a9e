// Results: histories at every step, fields at intervals, each at its own time and second order.
//
// Mid-step values (accelerations, reactions of energy-momentum) become values at t_n by linear interpolation between the two mid-points
// around it, a_n = (h_n a_{n+1/2} + h_{n+1} a_{n-1/2})/(h_n + h_{n+1}); at the ends and where a load jumps, by extrapolation from one side.
#pragma once
#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "dynamics/audit.hpp"
#include "dynamics/minimum_norm.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/slabs.hpp"
#include "dynamics/start.hpp"
#include "model/store.hpp"

namespace hilo {

class StressRecovery;

/// Path without its .h5.
std::string stem(const std::string& path);

class Recorder {
 public:
  struct Setup {
    std::string path;     // run.h5
    double interval = 0;  // between fields [s]
    std::vector<std::string> fields;
    bool single_precision = false;
    bool skin = false;          // fields of the nodes on the surfaces of regions alone
    std::vector<double> jumps;  // times at which forces or velocities jump
    std::vector<std::string> provenance;
    bool redundant = false;  // reactions by minimum norm
    double own_time = 0.5;   // where in the step mid values belong
    bool alternates = true;  // whether they alternate about the true ones
    bool is_static = false;

    bool wants(std::string_view field) const { return std::find(fields.begin(), fields.end(), field) != fields.end(); }
  };
  Recorder(const System& system, const Scene& scene, Setup setup);
  /// The state before the first step.
  void first(const State& s, const Ledger& ledger);
  /// A finished step: the new state and its account, the last stage for reactions, accelerations and Newton iterations.
  void step(const State& s, const Ledger& ledger, const Taken& taken, const Config& a, int iterations);
  /// Last values; publishes the files.  `complete` is false for a run stopped by physics.
  void finish(bool complete);
  /// Remove what was written (input error after the file was opened).
  void discard();

  int n_fields() const { return n_fields_; }
  std::int64_t n_rows() const { return static_cast<std::int64_t>(rows_written_); }

 private:
  struct Row {  // an instant t_n
    double t = 0;
    std::vector<double> point;  // values that belong to t_n
    bool jump = false, field = false;
    Config q, v;  // kept where a field is due
    int newton = 0;
  };
  struct Interval {  // what belongs to the inside of a step
    double h = 0;
    std::vector<double> mid;
    Config a;
    bool starts_at_jump = false;
  };
  void declare();
  void declare_arrays(Store& f);
  void write_histories(Store& f, const Row& row, const std::vector<double>& mid) const;
  void on_store(const std::function<void(Store&)>& write);
  void share_failure() const;
  std::vector<double> point_values(const State& s, const Ledger& ledger);
  std::vector<double> mid_values(const Stage& stage, std::span<const double> lambda, const Config& a);
  void advance(bool last);
  std::vector<std::pair<double, const Interval*>> extrapolated(const std::vector<const Interval*>& m, bool from_right) const;
  void write_row(const std::vector<std::pair<double, const Interval*>>& weights);
  void write_field(const Row& row, const Config& a);
  void write_stress(const Row& row, const std::string& group);
  void write_piece(const Slabs& rows, const std::string& array, const std::vector<double>& piece, int width, const char* unit,
                   const char* meaning, bool exact = false);
  void declare_rows();
  void write_skin(const std::vector<Facet>& facets);
  void write_topology();
  void write_xdmf();

  const System& system_;
  const Scene& scene_;
  Setup setup_;
  MinimumNorm share_;                // of redundant joints
  std::vector<Output> outputs_;      // of the contributions
  std::vector<std::string> arrays_;  // theirs, as declared
  size_t n_mid_ = 0;                 // numbers of all outputs that belong inside a step
  std::unique_ptr<Store> store_;     // rank 0
  std::optional<Error> failure_;     // of a write of this rank
  std::deque<Row> rows_;
  std::deque<Interval> intervals_;  // interval k starts at row k of rows_
  std::deque<Interval> past_;       // the two intervals before intervals_[0], for the last row
  bool first_written_ = false;
  double last_t_ = 0, next_field_ = 0;
  int n_fields_ = 0;
  std::shared_ptr<const StressRecovery> recovery_;          // made with the first field that needs it
  std::optional<Slabs> nodes_, cells_;                      // rows of the fields
  std::vector<std::int64_t> node_row_;                      // of local nodes, also those of other ranks; -1: not written
  std::int64_t topology_entries_ = 0, topology_cells_ = 0;  // of XDMF's list
  long rows_written_ = 0;
  double last_flush_ = wall_clock(), last_xdmf_ = wall_clock();
  std::vector<double> field_times_;
};

}  // namespace hilo
