// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/coupling.hpp"

#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "linear/petsc/session.hpp"

namespace hilo::petsc {

Coupling::Coupling(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared) {
  const int n_local = static_cast<int>(map.global.size());
  m_ = static_cast<int>(3 * (map.n_global - map.first_dense));
  dense_.resize(n_local), position_.assign(n_local, -1);
  for (int i = 0; i < n_local; ++i) {
    const auto g = map.global[i];
    dense_[i] = g >= map.first_dense ? static_cast<int>(g - map.first_dense) : -1;
    if (dense_[i] < 0 && shared.is_owned(i)) position_[i] = static_cast<int>(g - map.first);
  }
  if (size() > 1) {  // the vectors keep p at the end of the last rank's unknowns
    const bool last = rank() == size() - 1;
    const auto mine = std::max<std::int64_t>(0, map.first + map.n_owned - std::max(map.first_dense, map.first));
    if (3 * mine != (last ? m_ : 0)) fail("bodies and multipliers must belong to the last rank", static_cast<int>(Exit::fault));
  }
  for (int e = 0; e < cliques.size(); ++e) {
    if (!couples(cliques[e])) continue;
    for (const int i : cliques[e])
      for (const int j : cliques[e])
        if (i >= 0 && j >= 0 && dense_[i] < 0 && dense_[j] >= 0) couples_.push_back({i, dense_[j]});
  }
  const auto tidy = [&] {
    std::sort(couples_.begin(), couples_.end());
    couples_.erase(std::unique(couples_.begin(), couples_.end()), couples_.end());
  };
  tidy();
  // couples of blocks that others own
  std::vector<std::vector<PetscInt>> send(size());
  std::vector<std::vector<Couple>> sent(size());
  for (const Couple& c : couples_) {
    if (position_[c.flexible] >= 0) continue;
    const int r = shared.owner(map.global[c.flexible]);
    send[r].push_back(static_cast<PetscInt>(map.global[c.flexible]));
    send[r].push_back(c.dense);
    sent[r].push_back(c);
  }
  const auto got = comm().exchange(send);
  for (const auto& list : got)
    for (size_t k = 0; k < list.size(); k += 2) couples_.push_back({shared.owned(list[k] - map.first), list[k + 1]});
  tidy();
  start_.assign(n_local + 1, 0);
  for (const Couple& c : couples_) ++start_[c.flexible + 1];
  for (int i = 0; i < n_local; ++i) start_[i + 1] += start_[i];
  lent_.resize(size()), borrowed_.resize(size());
  for (int r = 0; r < size(); ++r) {
    for (const Couple& c : sent[r]) lent_[r].push_back(find(c.flexible, c.dense));
    for (size_t k = 0; k < got[r].size(); k += 2) borrowed_[r].push_back(find(shared.owned(got[r][k] - map.first), got[r][k + 1]));
  }
  std::vector<double> active(m_ / 3, 0);
  for (const Couple& c : couples_) active[c.dense] = 1;
  comm().max(active);
  for (int j = 0; j < m_; ++j)
    if (active[j / 3] > 0) columns_.push_back(j);
  B_.assign(9 * couples_.size(), 0.0), C_ = B_;
  find_pattern_of_D(cliques);
}

void Coupling::find_pattern_of_D(const Cliques& cliques) {
  const int n = m_ / 3;
  std::vector<PetscInt> pairs;  // row, column
  for (int e = 0; e < cliques.size(); ++e)
    for (const int i : cliques[e])
      for (const int j : cliques[e])
        if (i >= 0 && j >= 0 && dense_[i] >= 0 && dense_[j] >= 0) pairs.push_back(dense_[i]), pairs.push_back(dense_[j]);
  std::vector<std::vector<int>> columns(n);
  const auto take = [&](const std::vector<PetscInt>& list) {
    for (size_t k = 0; k < list.size(); k += 2) columns[list[k]].push_back(list[k + 1]);
    for (auto& row : columns) {
      std::sort(row.begin(), row.end());
      row.erase(std::unique(row.begin(), row.end()), row.end());
    }
  };
  take(pairs);
  if (size() > 1) {
    pairs.clear();
    for (int i = 0; i < n; ++i)
      for (const int j : columns[i]) pairs.push_back(i), pairs.push_back(j);
    for (const auto& list : comm().exchange(std::vector<std::vector<PetscInt>>(size(), pairs))) take(list);
  }
  D_start_.assign(1, 0);
  for (int i = 0; i < n; ++i) {
    if (!std::binary_search(columns[i].begin(), columns[i].end(), i))
      columns[i].insert(std::upper_bound(columns[i].begin(), columns[i].end(), i), i);
    D_column_.insert(D_column_.end(), columns[i].begin(), columns[i].end());
    D_start_.push_back(static_cast<int>(D_column_.size()));
  }
  D_.assign(9 * D_column_.size(), 0.0), summand_ = D_;
}

size_t Coupling::find_D(int row, int column) const {
  const auto at = std::lower_bound(D_column_.begin() + D_start_[row], D_column_.begin() + D_start_[row + 1], column);
  return 9 * static_cast<size_t>(at - D_column_.begin());
}

bool Coupling::couples(std::span<const int> blocks) const {
  return std::any_of(blocks.begin(), blocks.end(), [&](int i) { return i >= 0 && dense_[i] >= 0; });
}

size_t Coupling::find(int flexible, int dense) const {
  size_t k = start_[flexible];
  while (couples_[k].dense != dense) ++k;
  return k;
}

void Coupling::zero() {
  std::fill(B_.begin(), B_.end(), 0.0), std::fill(C_.begin(), C_.end(), 0.0), std::fill(D_.begin(), D_.end(), 0.0);
  std::fill(summand_.begin(), summand_.end(), 0.0);
}

void Coupling::add(std::span<const int> blocks, const double* K) {
  const size_t n = blocks.size(), width = 3 * n;
  const auto add_block = [](double* to, const double* from, size_t stride) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) to[3 * r + c] += from[r * stride + c];
  };
  for (size_t a = 0; a < n; ++a) {
    if (blocks[a] < 0) continue;
    const int i = dense_[blocks[a]];
    for (size_t b = 0; b < n; ++b) {
      if (blocks[b] < 0) continue;
      const int j = dense_[blocks[b]];
      const double* from = K + 3 * a * width + 3 * b;
      if (i >= 0 && j >= 0) add_block(&summand_[find_D(i, j)], from, width);
      if (i < 0 && j >= 0) add_block(&B_[9 * find(blocks[a], j)], from, width);
      if (i >= 0 && j < 0) add_block(&C_[9 * find(blocks[b], i)], from, width);
    }
  }
}

void Coupling::add_diagonal(int block, const double d[3]) {
  const size_t at = find_D(dense_[block], dense_[block]);
  for (int c = 0; c < 3; ++c) summand_[at + 4 * c] += d[c];
}

void Coupling::assemble() {
  comm().sum(summand_);
  for (size_t k = 0; k < D_.size(); ++k) D_[k] += summand_[k];
  std::fill(summand_.begin(), summand_.end(), 0.0);
  std::vector<std::vector<double>> send(size());
  for (int r = 0; r < size(); ++r)
    for (const size_t k : lent_[r]) {
      send[r].insert(send[r].end(), &B_[9 * k], &B_[9 * k] + 9);
      send[r].insert(send[r].end(), &C_[9 * k], &C_[9 * k] + 9);
      std::fill_n(&B_[9 * k], 9, 0.0), std::fill_n(&C_[9 * k], 9, 0.0);
    }
  const auto got = comm().exchange(send);
  for (int r = 0; r < size(); ++r)
    for (size_t n = 0; n < borrowed_[r].size(); ++n)
      for (int c = 0; c < 9; ++c) B_[9 * borrowed_[r][n] + c] += got[r][18 * n + c], C_[9 * borrowed_[r][n] + c] += got[r][18 * n + 9 + c];
}

void Coupling::symmetrise() {
  for (size_t k = 0; k < couples_.size(); ++k)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        double &b = B_[9 * k + 3 * r + c], &t = C_[9 * k + 3 * c + r];
        b = t = (b + t) / 2;
      }
  for (int i = 0; i < m_ / 3; ++i)
    for (int k = D_start_[i]; k < D_start_[i + 1] && D_column_[k] <= i; ++k) {
      const size_t other = find_D(D_column_[k], i);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) {
          double &a = D_[9 * static_cast<size_t>(k) + 3 * r + c], &t = D_[other + 3 * c + r];
          a = t = (a + t) / 2;
        }
    }
}

void Coupling::add_D(const double* p, double* q) const {
  for_each_D([&](int i, int j, const double* D) {
    for (int r = 0; r < 3; ++r) q[3 * i + r] += D[3 * r] * p[3 * j] + D[3 * r + 1] * p[3 * j + 1] + D[3 * r + 2] * p[3 * j + 2];
  });
}

void Coupling::add_B(double factor, const double* p, double* u) const {
  for (size_t k = 0; k < couples_.size(); ++k) {
    const int at = position_[couples_[k].flexible];
    if (at < 0) continue;
    const double* x = p + 3 * couples_[k].dense;
    for (int r = 0; r < 3; ++r)
      u[3 * static_cast<size_t>(at) + r] +=
          factor * (B_[9 * k + 3 * r] * x[0] + B_[9 * k + 3 * r + 1] * x[1] + B_[9 * k + 3 * r + 2] * x[2]);
  }
}

void Coupling::column(int j, double* u, size_t n) const {
  std::memset(u, 0, n * sizeof(double));
  for (size_t k = 0; k < couples_.size(); ++k) {
    const int at = position_[couples_[k].flexible];
    if (at < 0 || couples_[k].dense != j / 3) continue;
    for (int r = 0; r < 3; ++r) u[3 * static_cast<size_t>(at) + r] = B_[9 * k + 3 * r + j % 3];
  }
}

void Coupling::add_C(double factor, const double* u, double* p) const {
  for (size_t k = 0; k < couples_.size(); ++k) {
    const int at = position_[couples_[k].flexible];
    if (at < 0) continue;
    const double* x = u + 3 * static_cast<size_t>(at);
    for (int r = 0; r < 3; ++r)
      p[3 * couples_[k].dense + r] += factor * (C_[9 * k + 3 * r] * x[0] + C_[9 * k + 3 * r + 1] * x[1] + C_[9 * k + 3 * r + 2] * x[2]);
  }
}

}  // namespace hilo::petsc
