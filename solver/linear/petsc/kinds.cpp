#include "linear/petsc/kinds.hpp"

#include <algorithm>

#include "linear/petsc/block_matrix.hpp"
#include "linear/petsc/subdomain_matrix.hpp"
#include "linear/petsc/symmetric_matrix.hpp"

namespace hilo::petsc {
namespace {

std::unique_ptr<BlockMatrix> flexible_blocks(const FlexibleInput& in) {
  return std::make_unique<BlockMatrix>(in.cliques, in.map, in.shared, in.map.first_dense);
}

Flexible whole(const FlexibleInput& in) {
  auto F = flexible_blocks(in);
  auto inverse = make_algebraic_inverse(*F, in.positions);
  return {std::move(F), std::move(inverse)};
}

Flexible symmetric_part(const FlexibleInput& in) {
  auto F = std::make_unique<SymmetricMatrix>(in.cliques, in.map, in.shared);
  auto inverse = make_algebraic_inverse(
      *F, [in] { return flexible_blocks(in); }, in.positions);
  return {std::move(F), std::move(inverse)};
}

Flexible subdomains(const FlexibleInput& in, std::unique_ptr<FlexibleInverse> (*make)(const SubdomainMatrix&)) {
  auto F = std::make_unique<SubdomainMatrix>(in.cliques, in.map, in.shared, in.subdomains);
  auto inverse = make(*F);
  if (comm().max(in.positions.empty() ? 0 : 1) > 0) inverse = make_deflated(std::move(inverse), *F, in.positions);
  return {std::move(F), std::move(inverse)};
}

}  // namespace

std::span<const SolverKind> solver_kinds() {
  static const std::vector<SolverKind> kinds{
      {.word = "cg", .title = "iterative", .make = symmetric_part, .is_symmetric = true},
      {.word = "iterative", .title = "iterative", .make = whole},
      {.word = "bddc", .title = "BDDC", .make = [](const FlexibleInput& in) { return subdomains(in, make_bddc); }, .goes_direct = true},
      {.word = "feti-dp",
       .title = "FETI-DP",
       .make = [](const FlexibleInput& in) { return subdomains(in, make_feti_dp); },
       .goes_direct = true},
  };
  return kinds;
}

const SolverKind* find_kind(const std::string& word) {
  const auto kinds = solver_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const SolverKind& k) { return k.word == word; });
  return found == kinds.end() ? nullptr : &*found;
}

}  // namespace hilo::petsc
