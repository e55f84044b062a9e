// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/hand_over.hpp"

namespace hilo::petsc {

std::unique_ptr<DirectSolver> hand_over(const FlexibleMatrix& F, const Coupling& coupling, const Cliques& cliques, const BlockMap& map,
                                        double tolerance) {
  auto direct = std::make_unique<DirectSolver>(tolerance);
  direct->structure(cliques, map);
  direct->zero();
  BlockMatrix& A = direct->matrix();
  const auto first_dense = static_cast<PetscInt>(map.first_dense);
  F.for_each_row([&](PetscInt row, std::span<const PetscInt> columns, const double* values) { A.add_row(row, columns, values); });
  coupling.for_each_couple([&](int local, int dense, const double* B, const double* C) {
    const PetscInt u = static_cast<PetscInt>(map.global[local]), p = first_dense + dense;
    A.add_row(u, {&p, 1}, B), A.add_row(p, {&u, 1}, C);
  });
  if (map.first + map.n_owned > map.first_dense)  // the last rank's
    coupling.for_each_D([&](int i, int j, const double* D) {
      const PetscInt column = first_dense + j;
      A.add_row(first_dense + i, {&column, 1}, D);
    });
  return direct;
}

}  // namespace hilo::petsc
