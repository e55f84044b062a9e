// SPDX-License-Identifier: GPL-3.0-or-later
// Serial factors of a saddle-point matrix.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "linear/block_csr.hpp"

namespace hilo {

class Factors {
 public:
  virtual ~Factors() = default;
  /// False when the matrix is singular, or not what this kind can factor.
  virtual bool factor(const BlockCsr& A) = 0;
  /// With the pivots of the last factorisation, where a kind has them to keep; they may be bad ones for this matrix.
  virtual bool refactor(const BlockCsr&) { return false; }
  /// x := P^-1 b, P the matrix factored last or near it; b and x are different arrays.
  virtual void solve(const double* b, double* x) = 0;
  /// Whether there is a more accurate form, which the next factorisation takes.
  virtual bool sharpen() { return false; }
  /// The matrix has become A: takes up what costs little, so that the factors serve it better.  False: they serve no more.
  virtual bool follow(const BlockCsr& /*A*/) { return true; }
  /// Where a kind factors definite matrices alone: whether the one at hand was one.
  virtual bool are_of_definite() const { return true; }
  /// What a factorisation costs, in solves.
  virtual double cost() const = 0;
  virtual std::string name() const = 0;
  virtual double bytes() const = 0;
};

/// Solves that take as long as `flops` of dense factorisation: a solve reads its entries once at memory speed, eight flops each.
inline double factor_cost(double flops, double entries) { return 1 + flops / (16 * (entries + 1)); }

/// LU that keeps its pivots while they serve [davis-2010]; for some thousand unknowns, of bodies and joints alone (`of_bodies`) some ten
/// thousand.
std::unique_ptr<Factors> make_klu(bool of_bodies = false);
/// Unsymmetric multifrontal LU [davis-2004].
std::unique_ptr<Factors> make_umfpack();
/// Cholesky factors of the flexible blocks [chen-2008] and the Schur complement of the others, of the matrix's symmetric part.
/// `is_dense`: of each block, whether it is a body's or a multiplier's; `joined`: whether what changes more than cells do, as contact,
/// joins it to others.
std::unique_ptr<Factors> make_cholesky(const std::vector<char>& is_dense, const std::vector<char>& joined = {});

}  // namespace hilo
