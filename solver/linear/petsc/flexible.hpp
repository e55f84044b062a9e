// SPDX-License-Identifier: GPL-3.0-or-later
// The flexible block F of a system, and an approximate inverse of it: a fixed linear operator, or nearly so, so that the Schur complement
// of bodies and multipliers can be formed with it.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscmat.h>

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "linear/kkt.hpp"
#include "linear/petsc/shared.hpp"

namespace hilo::petsc {

class FlexibleMatrix {
 public:
  virtual ~FlexibleMatrix() = default;
  virtual void zero() = 0;
  /// Add the flexible part of a clique's dense matrix; `blocks` are the clique's.
  virtual void add(int clique, std::span<const int> blocks, const double* K) = 0;
  virtual void add_diagonal(int block, const double d[3]) = 0;
  virtual void assemble() = 0;
  virtual Mat mat() const = 0;
  virtual PetscInt n_owned() const = 0;  // blocks
  virtual double bytes() const = 0;      // of this rank
  /// What this rank has of the assembled matrix: of each row of blocks by global numbers, its columns and 3 x 3n values, row major.
  using Row = std::function<void(PetscInt row, std::span<const PetscInt> columns, const double* values)>;
  virtual void for_each_row(const Row& row) const = 0;
  /// The largest |K - K^T| / |K + K^T| of the cliques added on this rank since zero(), where the kind keeps the symmetric part alone.
  virtual double asymmetry() const { return 0; }
};

class FlexibleInverse {
 public:
  virtual ~FlexibleInverse() = default;
  /// Make it anew for the matrix as it is now.  False when the factors break down.
  virtual bool set_up() = 0;
  /// X := M X, owned flexible unknowns; several columns at once read the factors once.
  virtual void apply(Eigen::Ref<Eigen::MatrixXd> X) = 0;
  /// After a solve of so many iterations, or one that failed: whether a stronger kind takes over.
  virtual bool strengthen(int iterations, bool failed) = 0;
  /// Does an application differ a little from a linear operator: iterative itself, or in single precision?
  virtual bool varies() const { return false; }
  /// Has an application failed since the set-up?  The same on all ranks.
  virtual bool has_failed() const { return false; }
  /// Outer iterations after which there is no hope.
  virtual int most_iterations() const { return 600; }
  /// Iterations within the applications since the last call: of all, and of the one with most.
  struct Within {
    int all = 0, most = 0;
  };
  virtual Within take_iterations() { return {}; }
  virtual double undivided_seconds() const { return 0; }
  virtual std::string name() const = 0;
  virtual double bytes() const = 0;
};

struct Flexible {
  std::unique_ptr<FlexibleMatrix> matrix;
  std::unique_ptr<FlexibleInverse> inverse;  // refers to the matrix
};

/// The rigid motions of the owned positions (3 each) as near null space; false where no rank has positions.
bool set_near_null_space(Mat A, const std::vector<double>& positions);

class BlockMatrix;
class SubdomainMatrix;
class SymmetricMatrix;

/// Incomplete factors, and multigrid where they need too many iterations.  `positions`: of the owned blocks, 3 each, for the rigid modes;
/// may be empty.
std::unique_ptr<FlexibleInverse> make_algebraic_inverse(const BlockMatrix& F, std::vector<double> positions);
/// Likewise; `make_whole` makes an empty matrix of the same pattern, for multigrid.
std::unique_ptr<FlexibleInverse> make_algebraic_inverse(const SymmetricMatrix& F, std::function<std::unique_ptr<BlockMatrix>()> make_whole,
                                                        std::vector<double> positions);
/// Balancing domain decomposition, and solving for the forces between subdomains.
std::unique_ptr<FlexibleInverse> make_bddc(const SubdomainMatrix& F);
std::unique_ptr<FlexibleInverse> make_feti_dp(const SubdomainMatrix& F);
/// `inner`, made exact on the rigid motions of connected parts.
std::unique_ptr<FlexibleInverse> make_deflated(std::unique_ptr<FlexibleInverse> inner, const SubdomainMatrix& F,
                                               std::vector<double> positions);

}  // namespace hilo::petsc
