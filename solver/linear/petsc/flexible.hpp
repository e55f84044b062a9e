// An approximate inverse of the flexible block: one fixed linear operator, so that the Schur complement can be formed with it.
//
// Incomplete factors (block Jacobi over the ranks, ILU(0) in 3 x 3 blocks) are best while a wave crosses few hundred elements in a step;
// beyond, smoothed aggregation multigrid is (docs/accuracy-and-speed.md).  Which one is settled by the iterations the last solve took.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscpc.h>

#include <vector>

#include "linear/petsc/block_matrix.hpp"

namespace hilo::petsc {

class FlexibleInverse {
 public:
  enum class Kind { incomplete, multigrid };
  /// `positions`: of the owned blocks, 3 each, for multigrid's rigid modes; may be empty.
  FlexibleInverse(const BlockMatrix& F, std::vector<double> positions) : F_(F), positions_(std::move(positions)) {}
  ~FlexibleInverse() { release(); }
  FlexibleInverse(const FlexibleInverse&) = delete;

  /// Make it anew for the matrix as it is now.  False when the factors break down.
  bool set_up();
  void apply(Vec b, Vec x) { check(PCApply(pc_, b, x)); }
  void use(Kind kind);
  Kind kind() const { return kind_; }
  double bytes() const;

 private:
  void release();
  const BlockMatrix& F_;
  std::vector<double> positions_;
  Kind kind_ = Kind::incomplete;
  PC pc_ = nullptr;
  Mat scalar_ = nullptr;  // F without blocks: multigrid wants it so
};

}  // namespace hilo::petsc
