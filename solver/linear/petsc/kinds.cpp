// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/kinds.hpp"

#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/subdomain_matrix.hpp"
#include "linear/petsc/symmetric_matrix.hpp"

namespace hilo::petsc {
namespace {

Flexible whole(const FlexibleInput& in) {
  auto F = std::make_unique<BlockMatrix>(in.cliques, in.map, in.shared, in.map.first_dense);
  auto inverse = make_algebraic_inverse(*F, in.positions);
  return {std::move(F), std::move(inverse)};
}

Flexible symmetric_part(const FlexibleInput& in) {
  auto F = std::make_unique<SymmetricMatrix>(in.cliques, in.map, in.shared);
  const auto make_whole = [&cliques = in.cliques, &map = in.map, &shared = in.shared] {
    return std::make_unique<BlockMatrix>(cliques, map, shared, map.first_dense);
  };
  auto inverse = make_algebraic_inverse(*F, make_whole, in.positions);
  return {std::move(F), std::move(inverse)};
}

Flexible subdomains(const FlexibleInput& in, std::unique_ptr<FlexibleInverse> (*make)(const SubdomainMatrix&)) {
  auto F = std::make_unique<SubdomainMatrix>(in.cliques, in.map, in.shared, in.subdomains);
  auto inverse = make(*F);
  if (comm().max(in.positions.empty() ? 0 : 1) > 0) inverse = make_deflated(std::move(inverse), *F, in.positions);
  return {std::move(F), std::move(inverse)};
}

}  // namespace

Registry<PetscKind>& solver_kinds() {
  static Registry<PetscKind> kinds{
      "PETSc solver",
      {
          {.name = "cg", .title = "iterative", .make = symmetric_part, .is_symmetric = true},
          {.name = "iterative", .title = "iterative", .make = whole},
          {.name = "bddc", .title = "BDDC", .make = [](const FlexibleInput& in) { return subdomains(in, make_bddc); }, .goes_direct = true},
          {.name = "feti-dp",
           .title = "FETI-DP",
           .make = [](const FlexibleInput& in) { return subdomains(in, make_feti_dp); },
           .goes_direct = true},
      }};
  return kinds;
}

}  // namespace hilo::petsc
