// SPDX-License-Identifier: GPL-3.0-or-later
// The linear solve of a Newton step: one sparse unsymmetric saddle-point system in 3 x 3 blocks,
//
//     [ K    G_left^T ] [ dq      ]     [ r ]
//     [ G_right     0 ] [ dlambda ] = - [ g ]
//
// handed over as dense blocks of cliques (an element, a joint).  It has never heard of an element or a joint.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hilo {

/// Which blocks couple: clique i covers blocks[offset[i] .. offset[i+1]), local numbers (-1: none), dense in that order.  One of a cell is
/// its rank's own; one of a joint may stand on several ranks, of which one adds to it.
struct Cliques {
  std::vector<int> offset{0};
  std::vector<int> blocks;
  std::vector<char> own;
  int add(std::span<const int> list, bool is_own = false) {
    own.push_back(is_own);
    blocks.insert(blocks.end(), list.begin(), list.end());
    offset.push_back(static_cast<int>(blocks.size()));
    return static_cast<int>(offset.size()) - 2;
  }
  std::span<const int> operator[](int i) const { return {blocks.data() + offset[i], static_cast<size_t>(offset[i + 1] - offset[i])}; }
  int size() const { return static_cast<int>(offset.size()) - 1; }
};

/// Local blocks and their global numbers.  Each rank owns the global range [first, first + n_owned); local block i has number global[i].
struct BlockMap {
  std::vector<std::int64_t> global;  // (n_local)
  std::int64_t first = 0, n_owned = 0, n_global = 0;
  std::int64_t first_dense = 0;   // global blocks from here on belong to bodies and multipliers; the last rank owns them
  std::int64_t n_with_cells = 0;  // the first of these, of bodies that cells hold alone: they are definite as cells are
  std::vector<double> X;          // positions of the local blocks (n_local x 3), or empty: multigrid finds rigid motions from them [m]
};

/// What a solve did.
struct SolveReport {
  bool ok = true;
  double residual = 0;  // |A x - b|/|b| in the maximum norm, by multiplication, not claimed by the solver
  int iterations = 0;   // 0 for a direct solver
  std::string message;
  int most_within = 0;       // of one solve within the preconditioner, where that iterates
  bool is_singular = false;  // the matrix has no inverse

  static SolveReport failed(std::string message, double residual = 1) {
    return {.ok = false, .residual = residual, .message = std::move(message)};
  }
  static SolveReport singular(const std::string& how = "", double residual = 1) {
    return {.ok = false, .residual = residual, .message = "the matrix is singular" + how, .is_singular = true};
  }
};

class KktSolver {
 public:
  virtual ~KktSolver() = default;
  virtual void structure(const Cliques& cliques, const BlockMap& map) = 0;
  /// An empty matrix; what was added and never solved with is given up.
  virtual void zero() = 0;
  /// Add the dense matrix (3n x 3n, row major) of a clique.
  virtual void add(int clique, const double* K) = 0;
  /// Add to the diagonal of a local block (its owner's call only).
  virtual void add_diagonal(int block, const double d[3]) = 0;
  /// Sum what ranks hold of shared blocks; afterwards every rank sees the full values of its local blocks.
  virtual void sum_shared(std::span<double> local) = 0;
  /// Solve A x = b; b has the full values of the local blocks, x gets them.  `tolerance`: the relative residual that suffices, to a solver
  /// that iterates and could stop there.
  virtual SolveReport solve(std::span<const double> b, std::span<double> x, double tolerance = 0) = 0;
  /// Whether a further solve with the same matrix costs little beside the first.
  virtual bool repeats_cheaply() const { return false; }
  /// Eigenvalues below zero of K, assembled last, on the motions that the rows from block `first_row` on allow (linear/inertia); nothing
  /// where that is not known.
  virtual std::optional<int> eigenvalues_below_zero(int /*first_row*/) { return {}; }
  virtual std::string name() const = 0;
  /// Seconds so far that went into factors and preconditioners.
  virtual double set_up_seconds() const { return 0; }
  /// Seconds so far of what every rank does for itself because it is not divided among them: coarse problems.
  virtual double undivided_seconds() const { return 0; }
  /// Memory of the matrix and its factors on this rank, where known.
  virtual double bytes() const { return 0; }
};

class SerialKktSolver : public KktSolver {
 public:
  /// Add a part (3n x 3n, row major) of the matrix of a clique: rows from its block `row` on, columns from its block `column` on.
  virtual void add_part(int clique, int row, int column, int n, const double* K) = 0;
};

/// Serial, starts in microseconds: "klu", "cholesky" or "umfpack" (linear/factors.hpp); "light" chooses by size.
std::unique_ptr<SerialKktSolver> make_light_solver(const std::string& kind = "light");
/// PETSc: "direct" (MUMPS), "cg", "iterative", "bddc" or "feti-dp"; loaded when first asked for, since PETSc's start costs more than a
/// small run. `subdomains`: into how many "bddc" and "feti-dp" divide the flexible part of each rank.
std::unique_ptr<KktSolver> make_petsc_solver(const std::string& kind, double tolerance, int subdomains = 1);

}  // namespace hilo
