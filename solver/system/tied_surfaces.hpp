// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that are tied though their meshes do not match: mortar rows (system/mortar), linear in positions with constant weights.
//
// The weights of a row sum to zero, and the row vanishes in the reference: multipliers have neither a resultant nor a moment.  Nodes that
// follow a body take part by its motion.  The row of a node that is held is shared by the rows beside it, so that they still reproduce a
// constant [puso-2004]: it would hold nodes of a.  Rows that depend on others (of two ties, or between nodes that are held) are chosen off
// at the start; as all rows are linear and vanish in the reference, those that are kept imply them.
//
// Nodes of a linear region are an interface of its modes.  Where they are few, each moves by modes of its own and has a row as a node of
// cells has.  Where they are many, they move by smooth functions P_j of place; the rows of b are then sum_i P_j(X_i) n_ii row_i, as many as
// there are functions: multipliers are smooth functions too, a uniform traction among them.
#pragma once
#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "system/contribution.hpp"

namespace hilo {

/// Nodes of a linear region that ties hold, an interface of its modes.
struct TiedGroup {
  std::string name;
  int body = -1;              // mean axes of the region
  std::vector<int> nodes;     // local, in the order of the mesh
  Eigen::MatrixXd functions;  // smooth ones by which the nodes move (n x k); empty where each moves by itself
  bool smooth() const { return functions.size() > 0; }
};

/// On rank 0, which has all nodes of both sides; the other ranks know which components are on.
struct TiedRow {
  int node = -1;                             // of b, whose weight is 1; -1: of smooth functions of a linear region
  std::vector<std::pair<int, double>> term;  // local nodes and weights, of which the sum is zero
  std::array<bool, 3> on{true, true, true};  // components
  std::array<bool, 3> implied{};             // that are off, as others have all of them
  std::int64_t number = -1;                  // of the node in the deck
  double own = 1;                            // the area of the node, by which weights were divided [m^2]
};

struct SurfaceTie {
  std::string name;
  std::vector<TiedRow> rows;
  std::map<int, std::set<int>> beside;     // nodes of b that share a facet, until the rows are chosen
  std::vector<int> b_nodes;                // ascending
  std::vector<int> tied;                   // of these, with a row
  int n_nodes = 0, n_tied = 0, n_off = 0;  // of b; with a row; components of rows that others imply
  bool turned = false;                     // the scene names as b what is rigid: it is a here
  double covered = 0, largest_move = 0;    // share of the area of b [1]; of a node at the start [m]
};

class TiedSurfaces final : public Contribution, public Equations, public Constraining, public Observer {
 public:
  explicit TiedSurfaces(const Points& points) : points_(points) {}
  std::vector<SurfaceTie> list;
  std::vector<TiedGroup> groups;  // on rank 0
  std::map<int, int> group_of;    // of a node that follows a linear region
  std::map<int, int> welded_to;   // the body that a weld has such a node follow

  /// Switches off rows that depend on others.  Nodes, bodies and what is held must be known.
  void choose_rows();
  /// What all ranks have to know of the rows of rank 0.  Collective.
  void tell_rows();

  Traits traits() const override { return {.constrains = !list.empty(), .reaches = !list.empty()}; }
  std::string count() const override;
  void number(Layout& layout) override;
  std::string owner(int block) const override;
  void evaluate(Pass& p) const override;
  void look_at_rows(const Config& q, double t, double factor, Violation& worst) const override;
  void add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const override;
  void mark_rows(std::vector<char>& on) const override;
  void tie(Ties& ties) const override;
  std::vector<Output> outputs() const override;
  /// Force and moment on b about the mean of its nodes that are tied.
  void observe(const Sight& at) override;
  void add_to_report(Json& run) const override;

 private:
  bool is_free(int node, int component) const;
  void share_held(SurfaceTie& tie) const;
  void smooth(SurfaceTie& tie) const;
  bool is_smooth(int node) const;
  /// What of a row acts on one body: total weight, the weighted arms in its axes [m], and of a linear region the weighted shapes.
  struct OnBody {
    int body;
    double weight;
    Vec3 arm;
    std::vector<Vec3> shapes;
    std::vector<std::pair<int, double>> nodes;
  };
  struct Place {
    int block, clique;
    std::vector<std::pair<int, double>> nodes;  // free ones
    std::vector<OnBody> bodies;                 // free ones, and linear regions
  };
  template <class Use>
  void each(Use&& use) const;
  Vec3 value(const TiedRow& row, const Config& q) const;
  Place place_of(const TiedRow& row) const;
  /// What a component of a row says of the motions that it may hold, by column.
  std::map<std::int64_t, double> entries_of(const TiedRow& row, int component) const;
  const Points& points_;
  std::vector<Place> place_;  // by row, of all ties one after the other
};

class System;
/// Nodes of linear regions that ties hold, on rank 0.
const std::vector<TiedGroup>& tied_groups(const System& system);

}  // namespace hilo
