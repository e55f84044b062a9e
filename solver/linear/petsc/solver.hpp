// SPDX-License-Identifier: GPL-3.0-or-later
// What the PETSc solvers share.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "linear/kkt.hpp"
#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/shared.hpp"

namespace hilo::petsc {

std::unique_ptr<KktSolver> make_direct(double tolerance);
/// A vector of owned unknowns that frees itself.
class Vector {
 public:
  Vector() = default;
  explicit Vector(PetscInt n_owned) {
    check(VecCreate(PETSC_COMM_WORLD, &v_));
    check(VecSetSizes(v_, n_owned, PETSC_DETERMINE));
    check(VecSetType(v_, VECSTANDARD));
  }
  Vector(Vector&& other) noexcept : v_(std::exchange(other.v_, nullptr)) {}
  Vector& operator=(Vector&& other) noexcept {
    std::swap(v_, other.v_);
    return *this;
  }
  ~Vector() { VecDestroy(&v_); }
  operator Vec() const { return v_; }
  bool exists() const { return v_ != nullptr; }

 private:
  Vec v_ = nullptr;
};

/// Values of the owned unknowns of a vector, while it lives.
class Values {
 public:
  explicit Values(Vec v) : v_(v) { check(VecGetArray(v_, &x_)); }
  ~Values() { VecRestoreArray(v_, &x_); }
  Values(const Values&) = delete;
  double& operator[](size_t i) const { return x_[i]; }
  double* data() const { return x_; }

 private:
  Vec v_;
  double* x_ = nullptr;
};

/// Local blocks to owned unknowns, and back with the values of others.
inline void to_owned(const SharedBlocks& shared, std::span<const double> local, Vec v) {
  const Values x(v);
  for (std::int64_t k = 0; k < shared.n_owned(); ++k)
    for (int c = 0; c < 3; ++c) x[3 * k + c] = local[3 * shared.owned(k) + c];
}
inline void to_local(const SharedBlocks& shared, Vec v, std::span<double> local) {
  {
    const Values x(v);
    for (std::int64_t k = 0; k < shared.n_owned(); ++k)
      for (int c = 0; c < 3; ++c) local[3 * shared.owned(k) + c] = x[3 * k + c];
  }
  shared.copy_out(local);
}
inline double max_norm(Vec v) {
  double norm = 0;
  check(VecNorm(v, NORM_INFINITY, &norm));
  return norm;
}

}  // namespace hilo::petsc
