// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/subdomain_matrix.hpp"

#include <algorithm>
#include <map>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "linear/petsc/session.hpp"
#include "linear/petsc/split.hpp"

namespace hilo::petsc {
namespace {

/// Of each clique: do several ranks know it?  Only one all of whose flexible blocks are shared can be such.
std::vector<char> find_common(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared) {
  std::vector<char> common(cliques.size(), 0);
  if (size() == 1) return common;
  std::vector<std::vector<PetscInt>> ask(size());
  std::vector<std::vector<int>> asked(size());
  std::vector<std::int64_t> key;
  for (int e = 0; e < cliques.size(); ++e) {
    if (cliques.own[e]) continue;  // cells beside a patch may have the same blocks as others on another rank
    key.clear();
    bool alone = false, flexible = false;
    for (const int i : cliques[e]) {
      if (i < 0) continue;
      key.push_back(map.global[i]);
      flexible |= map.global[i] < map.first_dense;
      alone |= map.global[i] < map.first_dense && !shared.is_shared(i);
    }
    if (alone || !flexible) continue;
    std::sort(key.begin(), key.end());
    Digest digest;
    for (const auto g : key) digest.add(g);
    const std::uint64_t hash = digest.value();
    const int r = static_cast<int>((hash >> 33) % static_cast<unsigned>(size()));
    ask[r].push_back(static_cast<PetscInt>(hash & 0x7fffffff)), ask[r].push_back(static_cast<PetscInt>((hash >> 31) & 0x7fffffff));
    asked[r].push_back(e);
  }
  const auto got = comm().exchange(ask);
  std::map<std::pair<PetscInt, PetscInt>, std::pair<int, int>> known;  // last rank, number of ranks
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < got[r].size(); k += 2) {
      auto& [last, n] = known.try_emplace({got[r][k], got[r][k + 1]}, -1, 0).first->second;
      if (last != r) last = r, ++n;
    }
  std::vector<std::vector<PetscInt>> answer(size());
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < got[r].size(); k += 2) answer[r].push_back(known.at({got[r][k], got[r][k + 1]}).second);
  const auto told = comm().exchange(answer);
  for (int r = 0; r < size(); ++r)
    for (size_t k = 0; k < asked[r].size(); ++k) common[asked[r][k]] = told[r][k] > 1;
  return common;
}

}  // namespace

SubdomainMatrix::SubdomainMatrix(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, int n_subdomains) {
  n_owned_ = static_cast<PetscInt>(std::clamp<std::int64_t>(map.first_dense - map.first, 0, map.n_owned));
  first_ = static_cast<PetscInt>(map.first);
  choose_blocks(cliques, map, shared, n_subdomains);
  find_pattern(cliques);
  const auto n = static_cast<PetscInt>(3 * global_.size());
  check(MatCreate(PETSC_COMM_SELF, &local_));
  check(MatSetSizes(local_, n, n, n, n));
  check(MatSetType(local_, MATSEQBAIJ));
  check(MatSetBlockSize(local_, 3));
  check(MatSeqBAIJSetPreallocationCSR(local_, 3, start_.data(), columns_.data(), nullptr));
  check(MatSetOption(local_, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  make_operator();
}

SubdomainMatrix::~SubdomainMatrix() {
  MatDestroy(&A_), MatDestroy(&local_);
  VecScatterDestroy(&all_);
  VecDestroy(&in_), VecDestroy(&out_);
}

/// The sum over the subdomains as a linear operator: values out to all places, each matrix by its own, back and summed.
void SubdomainMatrix::make_operator() {
  const auto n = static_cast<PetscInt>(global_.size());
  Vec whole;
  IS from;
  check(VecCreate(PETSC_COMM_WORLD, &whole));
  check(VecSetSizes(whole, 3 * n_owned_, PETSC_DETERMINE));
  check(VecSetType(whole, VECSTANDARD));
  check(VecCreateSeq(PETSC_COMM_SELF, 3 * n, &in_)), check(VecDuplicate(in_, &out_));
  check(ISCreateBlock(PETSC_COMM_WORLD, 3, n, global_.data(), PETSC_COPY_VALUES, &from));
  check(VecScatterCreate(whole, from, in_, nullptr, &all_));
  check(ISDestroy(&from)), check(VecDestroy(&whole));
  check(MatCreateShell(PETSC_COMM_WORLD, 3 * n_owned_, 3 * n_owned_, PETSC_DETERMINE, PETSC_DETERMINE, this, &A_));
  const auto set = [&](MatOperation what, PetscErrorCode (*f)(Mat, Vec, Vec)) {
    check(MatShellSetOperation(A_, what, reinterpret_cast<void (*)(void)>(f)));
  };
  set(MATOP_MULT, [](Mat A, Vec x, Vec y) -> PetscErrorCode {
    void* self;
    const PetscErrorCode code = MatShellGetContext(A, &self);
    if (!code) static_cast<SubdomainMatrix*>(self)->multiply(x, y, false);
    return code;
  });
  set(MATOP_MULT_TRANSPOSE, [](Mat A, Vec x, Vec y) -> PetscErrorCode {
    void* self;
    const PetscErrorCode code = MatShellGetContext(A, &self);
    if (!code) static_cast<SubdomainMatrix*>(self)->multiply(x, y, true);
    return code;
  });
}

void SubdomainMatrix::multiply(Vec x, Vec y, bool transposed) {
  check(VecScatterBegin(all_, x, in_, INSERT_VALUES, SCATTER_FORWARD)), check(VecScatterEnd(all_, x, in_, INSERT_VALUES, SCATTER_FORWARD));
  check(transposed ? MatMultTranspose(local_, in_, out_) : MatMult(local_, in_, out_));
  check(VecSet(y, 0));
  check(VecScatterBegin(all_, out_, y, ADD_VALUES, SCATTER_REVERSE)), check(VecScatterEnd(all_, out_, y, ADD_VALUES, SCATTER_REVERSE));
}

void SubdomainMatrix::choose_blocks(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, int n_subdomains) {
  const int n = static_cast<int>(map.global.size());
  flexible_.resize(n), owned_place_.assign(n, -1);
  for (int i = 0; i < n; ++i) {
    flexible_[i] = map.global[i] < map.first_dense;
    if (flexible_[i] && shared.is_owned(i)) owned_place_[i] = static_cast<int>(map.global[i] - map.first);
  }
  const auto is_flexible = [&](int i) { return i >= 0 && flexible_[i]; };
  const auto common = find_common(cliques, map, shared);
  const auto subdomain = split_cliques(cliques, map, n_subdomains);
  std::vector<char> counts(cliques.size(), 1);
  std::vector<std::vector<int>> mine(n_subdomains);  // local blocks of each subdomain
  for (int e = 0; e < cliques.size(); ++e) {
    const auto blocks = cliques[e];
    if (common[e]) {
      const auto first = std::find_if(blocks.begin(), blocks.end(), is_flexible);
      counts[e] = std::count_if(blocks.begin(), blocks.end(), is_flexible) >= 2 && shared.is_owned(*first);
    }
    if (!counts[e]) continue;
    for (const int i : blocks)
      if (is_flexible(i)) mine[subdomain[e]].push_back(i);
  }
  for (auto& blocks : mine) {
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  }
  // the owner learns who has its blocks, and takes what nobody has
  std::vector<std::vector<PetscInt>> tell(size());
  for (const auto& blocks : mine)
    for (const int i : blocks) tell[shared.owner(map.global[i])].push_back(static_cast<PetscInt>(map.global[i]));
  holders_.assign(n_owned_, {});
  const auto told = comm().exchange(tell);
  for (int r = 0; r < size(); ++r)
    for (const auto g : told[r]) holders_[g - map.first].push_back(r);
  for (PetscInt k = 0; k < n_owned_; ++k)
    if (holders_[k].empty()) holders_[k].push_back(rank()), mine[0].push_back(shared.owned(k));
  std::sort(mine[0].begin(), mine[0].end());
  // places: subdomain after subdomain
  std::vector<PetscInt> first_place(n_subdomains + 1, 0);
  for (int s = 0; s < n_subdomains; ++s) {
    first_place[s + 1] = first_place[s] + static_cast<PetscInt>(mine[s].size());
    for (const int i : mine[s]) {
      global_.push_back(static_cast<PetscInt>(map.global[i])), owner_.push_back(shared.owner(map.global[i]));
      if (!map.X.empty()) X_.insert(X_.end(), map.X.begin() + 3 * i, map.X.begin() + 3 * i + 3);
    }
  }
  offset_ = cliques.offset;
  place_.assign(cliques.blocks.size(), -1);
  const auto find_places = [&](int e, int s) {  // false where a flexible block is not in the subdomain
    bool all = true;
    for (int k = offset_[e]; k < offset_[e + 1]; ++k) {
      const int i = cliques.blocks[k];
      if (!is_flexible(i)) continue;
      const auto at = std::lower_bound(mine[s].begin(), mine[s].end(), i);
      const bool found = at != mine[s].end() && *at == i;
      place_[k] = found ? first_place[s] + static_cast<PetscInt>(at - mine[s].begin()) : -1;
      all &= found;
    }
    return all;
  };
  for (int e = 0; e < cliques.size(); ++e) {
    if (find_places(e, subdomain[e])) continue;
    int s = 0;  // a clique that does not count may lie in another subdomain
    while (s < n_subdomains && !find_places(e, s)) ++s;
    if (s == n_subdomains) find_places(e, subdomain[e]);
  }
  diagonal_.assign(3 * static_cast<size_t>(n_owned_), 0.0), waits_.assign(n_owned_, 0);
}

void SubdomainMatrix::find_pattern(const Cliques& cliques) {
  const auto n = static_cast<PetscInt>(global_.size());
  std::vector<int> start(n + 1, 0), list;
  for (const PetscInt i : place_)
    if (i >= 0) ++start[i + 1];
  for (PetscInt i = 0; i < n; ++i) start[i + 1] += start[i];
  list.resize(start[n]);
  auto at = start;
  for (int e = 0; e < cliques.size(); ++e)
    for (int k = offset_[e]; k < offset_[e + 1]; ++k)
      if (place_[k] >= 0) list[at[place_[k]]++] = e;
  std::vector<PetscInt> seen(n, -1), row;
  for (PetscInt i = 0; i < n; ++i) {
    row.assign(1, i), seen[i] = i;
    for (int k = start[i]; k < start[i + 1]; ++k)
      for (int b = offset_[list[k]]; b < offset_[list[k] + 1]; ++b)
        if (const PetscInt j = place_[b]; j >= 0 && seen[j] != i) seen[j] = i, row.push_back(j);
    std::sort(row.begin(), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    start_.push_back(static_cast<PetscInt>(columns_.size()));
  }
  columns_.shrink_to_fit();
}

void SubdomainMatrix::zero() {
  if (open_) assemble();  // what was added and never solved with
  open_ = true;
  check(MatZeroEntries(local_));
  std::fill(diagonal_.begin(), diagonal_.end(), 0.0), std::fill(waits_.begin(), waits_.end(), 0);
}

void SubdomainMatrix::add(int clique, std::span<const int> blocks, const double* K) {
  const size_t n = blocks.size();
  const PetscInt* index = place_.data() + offset_[clique];
  bool outside = false;
  for (size_t k = 0; k < n; ++k) outside |= blocks[k] >= 0 && index[k] < 0 && flexible_[blocks[k]];
  const auto m = static_cast<PetscInt>(n);
  check(MatSetValuesBlocked(local_, m, index, m, index, K, ADD_VALUES));
  if (!outside) return;
  for (size_t a = 0; a < n; ++a)  // a joint may name a block of another subdomain as long as it says nothing of it
    for (size_t b = 0; b < n; ++b) {
      if (blocks[a] < 0 || blocks[b] < 0 || !flexible_[blocks[a]] || !flexible_[blocks[b]] || (index[a] >= 0 && index[b] >= 0)) continue;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          if (K[(3 * a + r) * 3 * n + 3 * b + c] != 0) fail("a rank adds to a block outside its subdomain", static_cast<int>(Exit::fault));
    }
}

void SubdomainMatrix::add_diagonal(int block, const double d[3]) {
  const int k = owned_place_[block];
  for (int c = 0; c < 3; ++c) diagonal_[3 * static_cast<size_t>(k) + c] += d[c];
  waits_[k] = 1;
}

void SubdomainMatrix::assemble() {
  std::vector<std::vector<double>> send(size());
  for (PetscInt k = 0; k < n_owned_; ++k) {
    if (!waits_[k]) continue;
    const double share = 1.0 / static_cast<double>(holders_[k].size());
    for (const int r : holders_[k]) {
      send[r].push_back(static_cast<double>(first_ + k));
      for (int c = 0; c < 3; ++c) send[r].push_back(share * diagonal_[3 * static_cast<size_t>(k) + c]);
    }
    waits_[k] = 0;
    std::fill_n(&diagonal_[3 * static_cast<size_t>(k)], 3, 0.0);
  }
  std::map<PetscInt, std::vector<PetscInt>> places;  // of blocks that got something, the last first
  const auto got = comm().exchange(send);
  for (const auto& list : got)
    for (size_t k = 0; k < list.size(); k += 4) places[static_cast<PetscInt>(list[k])];
  if (!places.empty())
    for (size_t i = global_.size(); i-- > 0;)
      if (const auto it = places.find(global_[i]); it != places.end()) it->second.push_back(static_cast<PetscInt>(i));
  for (const auto& list : got)
    for (size_t k = 0; k < list.size(); k += 4) {
      auto& free = places.at(static_cast<PetscInt>(list[k]));  // a share for each subdomain
      const PetscInt i = free.back();
      free.pop_back();
      const double D[9] = {list[k + 1], 0, 0, 0, list[k + 2], 0, 0, 0, list[k + 3]};
      check(MatSetValuesBlocked(local_, 1, &i, 1, &i, D, ADD_VALUES));
    }
  check(MatAssemblyBegin(local_, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(local_, MAT_FINAL_ASSEMBLY));
  open_ = false;
}

void SubdomainMatrix::for_each_symmetric_block(const std::function<void(PetscInt, PetscInt, const double*)>& visit) const {
  PetscScalar* from;  // blocks by columns
  check(MatSeqBAIJGetArray(local_, &from));
  double block[9];
  for (PetscInt i = 0; i < n_blocks(); ++i)
    for (PetscInt k = start_[i]; k < start_[i + 1] && columns_[k] <= i; ++k) {
      const auto row = neighbours(columns_[k]);
      const auto other = start_[columns_[k]] + (std::lower_bound(row.begin(), row.end(), i) - row.begin());
      const PetscScalar *a = from + 9 * static_cast<size_t>(k), *t = from + 9 * static_cast<size_t>(other);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) block[3 * r + c] = 0.5 * (a[3 * c + r] + t[3 * r + c]);
      visit(i, columns_[k], block);
    }
  check(MatSeqBAIJRestoreArray(local_, &from));
}

void SubdomainMatrix::for_each_row(const Row& row) const {
  PetscScalar* from;
  check(MatSeqBAIJGetArray(local_, &from));
  std::vector<PetscInt> columns;
  std::vector<double> values;
  for (size_t i = 0; i < global_.size(); ++i) {
    const size_t width = start_[i + 1] - start_[i];
    columns.resize(width), values.resize(9 * width);
    for (size_t k = 0; k < width; ++k) {
      const PetscScalar* a = from + 9 * (start_[i] + k);
      columns[k] = global_[columns_[start_[i] + k]];
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) values[r * 3 * width + 3 * k + c] = a[3 * c + r];
    }
    row(global_[i], columns, values.data());
  }
  check(MatSeqBAIJRestoreArray(local_, &from));
}

double SubdomainMatrix::bytes() const {
  MatInfo info;
  double sum = 8. * static_cast<double>(columns_.size());
  if (!MatGetInfo(local_, MAT_LOCAL, &info)) sum += info.memory;
  return sum;
}

}  // namespace hilo::petsc
