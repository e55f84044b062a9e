// One evaluation in flight: what the parts of System::evaluate share.
#pragma once
#include "system/system.hpp"

namespace hilo {

struct System::Pass {
  const Stage& s;
  std::span<const double> lambda;
  Residual& out;
  KktSolver* K;             // null: residual only
  std::vector<Vec3>& node;  // residual of each node before reduction
  std::vector<Vec6>& body;  // residual of each body: force, moment about its left centre
  double sigma = 1;         // scale of constraint rows and multiplier columns

  void scale(double force) {
    if (force > out.force_scale) out.force_scale = force;
  }
};

/// Left and right maps of a node: identity for a free node, lever arms for a follower.
struct NodeMap {
  int slot;  // first row block within the clique's unknowns, -1 when driven
  bool follower;
  Vec3 left, right;  // arms from the body's centre
};

/// Work of a joint's drive from `from` to the end of the stage, for the multiplier of its row.
double drive_work(const Connector& c, const Stage& s, const Config& from, double lambda);

/// K (3n x 3n over nodes, row major) reduced to the unknowns of the clique's blocks (m blocks) and added to the solver.
/// Rows go through the left maps, columns through the right ones; prescribed components drop out.
void add_reduced(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed);

}  // namespace hilo
