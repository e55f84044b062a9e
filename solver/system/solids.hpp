// SPDX-License-Identifier: GPL-3.0-or-later
// Flexible cells: batches of one shape and law, each a run of calls of one kernel.
#pragma once
#include <cmath>

#include "physics/solid_kernel.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// Cells of one region and shape: one kernel, one set of constants.
struct SolidBatch {
  Shape shape;
  Material material;
  double density;              // [kg/m^3]
  double beta = 0, alpha = 0;  // stiffness- and mass-proportional damping [s, 1/s]
  double area = 0;             // of bars [m^2]
  double yield = HUGE_VAL;     // above which the material flows, as new; of a linear region it does not [Pa]
  int region;
  std::vector<int> cells;      // local cells
  std::vector<int> nodes;      // (n_cells x n)
  std::vector<double> height;  // of the cells, least at their first corner, where Newton asks how far it may go (n_cells) [m]
  int first_clique = 0;
  SolidKernel kernel;
  // What the cells remember (n_cells x kernel.n_state), evaluations read h0 and nothing but advance() writes h1, so that neither a step
  // that is cut nor an evaluation beside the steps leaves a trace.
  std::vector<double> h0, h1;  // accepted; at the end of the step tried last
  double dissipated = 0;       // by flow in that step [J]
};

/// What cells remember, by batch.
struct CellMemory {
  std::vector<std::vector<double>> batch;  // (n_cells x kernel.n_state)
  void archive(Archive& a) { a.cells(batch); }
};

class Solids final : public Contribution, public Equations, public Stateful, public Turning {
 public:
  explicit Solids(const Points& points) : points_(points) {}
  std::vector<SolidBatch> batches;  // of the cells of this rank

  Traits traits() const override;
  std::string count() const override;
  void prepare() override;
  void number(Layout& layout) override;
  std::string owner(int block) const override;
  void add_groups(std::vector<std::vector<int>>& groups) const override { groups.insert(groups.end(), nodes_.begin(), nodes_.end()); }
  void evaluate(Pass& p) const override;
  double longest_share(const Config& from, const Config& to) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void look_at_turn(const Config& q0, const Config& q1, int part, Turned& most) const override;
  std::string name(int item) const override;
  void advance(const Stage& stage) override;
  void settle(bool accepted) override;
  /// The state at the end of the step tried last, by batch.
  CellMemory memory() const;
  std::string fault(const Config& q) const override;
  void commit(const Config& q, const Config* v) override;
  void archive(Archive& a) override;
  void tie(Ties& ties) const override;

  /// Cluster of each free node, numbered over all ranks, the highest integer for a node of no cell; how many there are.
  int clusters(std::vector<std::int64_t>& cluster_of) const;

 private:
  void add_dissipation(const Stage& s, Work& sum) const;
  double mass_damping(const Stage& s) const;
  void watch_strain(const Config& q);
  const Points& points_;
  bool remembers_ = false;               // some rank has cells with a state
  bool is_thin_ = false;                 // some rank has shells
  bool some_ = false;                    // some rank has cells
  double least_height_ = 0;              // of the cells of this rank
  std::vector<std::vector<int>> nodes_;  // free ones of each region
  std::vector<char> strain_told_;        // by region: its compression has been told
};

}  // namespace hilo
