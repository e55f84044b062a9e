// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/block_matrix.hpp"

#include <algorithm>

#include "linear/petsc/session.hpp"

namespace hilo::petsc {
namespace {

/// Columns of each owned row, by global number: what the cliques of this rank say of it, and those of others.
struct Pattern {
  std::vector<PetscInt> start{0}, columns;
};

Pattern find_pattern(const Cliques& cliques, const std::vector<PetscInt>& global, const SharedBlocks& shared, PetscInt n_owned) {
  const int n_local = static_cast<int>(global.size());
  // cliques of each block
  std::vector<int> start(n_local + 1, 0), list;
  for (const int i : cliques.blocks)
    if (i >= 0 && global[i] >= 0) ++start[i + 1];
  for (int i = 0; i < n_local; ++i) start[i + 1] += start[i];
  list.resize(start[n_local]);
  auto at = start;
  for (int e = 0; e < cliques.size(); ++e)
    for (const int i : cliques[e])
      if (i >= 0 && global[i] >= 0) list[at[i]++] = e;
  std::vector<int>().swap(at);
  std::vector<int> seen(n_local, -1);
  std::vector<PetscInt> row;
  const auto gather = [&](int i) {
    row.assign(1, global[i]);
    seen[i] = i;
    for (int k = start[i]; k < start[i + 1]; ++k)
      for (const int j : cliques[list[k]])
        if (j >= 0 && global[j] >= 0 && seen[j] != i) seen[j] = i, row.push_back(global[j]);
  };
  // rows of others travel as (row, columns, their number)
  std::vector<std::vector<PetscInt>> send(size());
  for (int i = 0; i < n_local; ++i) {
    if (global[i] < 0 || shared.is_owned(i) || start[i] == start[i + 1]) continue;
    gather(i);
    auto& to = send[shared.owner(global[i])];
    to.push_back(global[i]);
    to.push_back(static_cast<PetscInt>(row.size()));
    to.insert(to.end(), row.begin(), row.end());
  }
  std::vector<std::pair<PetscInt, PetscInt>> others;
  for (const auto& got : comm().exchange(send))
    for (size_t k = 0; k < got.size(); k += 2 + got[k + 1])
      for (PetscInt c = 0; c < got[k + 1]; ++c) others.emplace_back(got[k], got[k + 2 + c]);
  std::sort(others.begin(), others.end());
  auto other = others.begin();
  Pattern p;
  for (PetscInt k = 0; k < n_owned; ++k) {
    const int i = shared.owned(k);
    gather(i);
    for (; other != others.end() && other->first == global[i]; ++other) row.push_back(other->second);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    p.columns.insert(p.columns.end(), row.begin(), row.end());
    p.start.push_back(static_cast<PetscInt>(p.columns.size()));
  }
  return p;
}

}  // namespace

BlockMatrix::BlockMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, std::int64_t n_global) {
  for (const auto g : map.global) global_.push_back(g < n_global ? static_cast<PetscInt>(g) : -1);
  n_owned_ = static_cast<PetscInt>(std::clamp<std::int64_t>(n_global - map.first, 0, map.n_owned));
  const Pattern p = find_pattern(cliques, global_, shared, n_owned_);
  check(MatCreate(PETSC_COMM_WORLD, &A_));
  check(MatSetSizes(A_, 3 * n_owned_, 3 * n_owned_, PETSC_DETERMINE, PETSC_DETERMINE));
  check(MatSetBlockSize(A_, 3));
  check(MatSetType(A_, MATBAIJ));
  check(MatSeqBAIJSetPreallocationCSR(A_, 3, p.start.data(), p.columns.data(), nullptr));
  check(MatMPIBAIJSetPreallocationCSR(A_, 3, p.start.data(), p.columns.data(), nullptr));
  check(MatSetOption(A_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  check(MatSetOption(A_, MAT_STRUCTURALLY_SYMMETRIC, PETSC_TRUE));
}

BlockMatrix::~BlockMatrix() { MatDestroy(&A_); }

void BlockMatrix::zero() {
  if (open_) assemble();  // what was added and never solved with
  check(MatZeroEntries(A_));
  open_ = true;
}

void BlockMatrix::add(int, std::span<const int> blocks, const double* K) {
  index_.resize(blocks.size());
  for (size_t k = 0; k < blocks.size(); ++k) index_[k] = blocks[k] < 0 ? -1 : global_[blocks[k]];
  const auto n = static_cast<PetscInt>(blocks.size());
  check(MatSetValuesBlocked(A_, n, index_.data(), n, index_.data(), K, ADD_VALUES));
}

void BlockMatrix::add_diagonal(int block, const double d[3]) {
  const double D[9] = {d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]};
  check(MatSetValuesBlocked(A_, 1, &global_[block], 1, &global_[block], D, ADD_VALUES));
}

void BlockMatrix::add_row(PetscInt row, std::span<const PetscInt> columns, const double* values) {
  check(MatSetValuesBlocked(A_, 1, &row, static_cast<PetscInt>(columns.size()), columns.data(), values, ADD_VALUES));
}

void BlockMatrix::assemble() {
  check(MatAssemblyBegin(A_, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(A_, MAT_FINAL_ASSEMBLY));
  open_ = false;
}

void BlockMatrix::for_each_row(const Row& row) const {
  PetscInt first = 0, last = 0, n = 0;
  check(MatGetOwnershipRange(A_, &first, &last));
  std::vector<PetscInt> columns;
  std::vector<double> values;
  for (PetscInt i = first; i < last; i += 3) {
    for (PetscInt r = 0; r < 3; ++r) {  // of a block row all have the same columns
      const PetscInt* at = nullptr;
      const PetscScalar* of = nullptr;
      check(MatGetRow(A_, i + r, &n, &at, &of));
      if (r == 0) columns.clear(), values.clear();
      for (PetscInt k = 0; k < n && r == 0; k += 3) columns.push_back(at[k] / 3);
      values.insert(values.end(), of, of + n);
      check(MatRestoreRow(A_, i + r, &n, &at, &of));
    }
    row(i / 3, columns, values.data());
  }
}

double BlockMatrix::bytes() const {
  MatInfo info;
  return MatGetInfo(A_, MAT_LOCAL, &info) ? 0 : info.memory;
}

}  // namespace hilo::petsc
