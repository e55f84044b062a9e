#include "linear/petsc/coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/error.hpp"
#include "linear/petsc/exchange.hpp"

namespace hilo::petsc {

Coupling::Coupling(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared) {
  const int n_local = static_cast<int>(map.global.size());
  m_ = static_cast<int>(3 * (map.n_global - map.first_dense));
  if (m_ > 6000)
    throw Error("", fmt::format("{} unknowns of bodies and joints are too many for the iterative solver", m_), "solver.kind = \"direct\"",
                Exit::resources);
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
  const auto got = exchange(send);
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
  std::vector<int> active(m_ / 3, 0);
  for (const Couple& c : couples_) active[c.dense] = 1;
  MPI_Allreduce(MPI_IN_PLACE, active.data(), m_ / 3, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  for (int j = 0; j < m_; ++j)
    if (active[j / 3]) columns_.push_back(j);
  B_.assign(9 * couples_.size(), 0.0), C_ = B_;
  D_.assign(static_cast<size_t>(m_) * m_, 0.0), summand_ = D_;
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
  const auto add_block = [](double* to, size_t stride, const double* from, size_t from_stride) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) to[r * stride + c] += from[r * from_stride + c];
  };
  for (size_t a = 0; a < n; ++a) {
    if (blocks[a] < 0) continue;
    const int i = dense_[blocks[a]];
    for (size_t b = 0; b < n; ++b) {
      if (blocks[b] < 0) continue;
      const int j = dense_[blocks[b]];
      const double* from = K + 3 * a * width + 3 * b;
      if (i >= 0 && j >= 0) add_block(&summand_[static_cast<size_t>(3 * i) * m_ + 3 * j], m_, from, width);
      if (i < 0 && j >= 0) add_block(&B_[9 * find(blocks[a], j)], 3, from, width);
      if (i >= 0 && j < 0) add_block(&C_[9 * find(blocks[b], i)], 3, from, width);
    }
  }
}

void Coupling::add_diagonal(int block, const double d[3]) {
  for (int c = 0; c < 3; ++c) summand_[static_cast<size_t>(3 * dense_[block] + c) * (m_ + 1)] += d[c];
}

void Coupling::assemble() {
  if (size() > 1) MPI_Allreduce(MPI_IN_PLACE, summand_.data(), static_cast<int>(summand_.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  for (size_t k = 0; k < D_.size(); ++k) D_[k] += summand_[k];
  std::fill(summand_.begin(), summand_.end(), 0.0);
  std::vector<std::vector<double>> send(size());
  for (int r = 0; r < size(); ++r)
    for (const size_t k : lent_[r]) {
      send[r].insert(send[r].end(), &B_[9 * k], &B_[9 * k] + 9);
      send[r].insert(send[r].end(), &C_[9 * k], &C_[9 * k] + 9);
      std::fill_n(&B_[9 * k], 9, 0.0), std::fill_n(&C_[9 * k], 9, 0.0);
    }
  const auto got = exchange(send);
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
  for (int i = 0; i < m_; ++i)
    for (int j = 0; j < i; ++j) {
      double &a = D_[static_cast<size_t>(i) * m_ + j], &t = D_[static_cast<size_t>(j) * m_ + i];
      a = t = (a + t) / 2;
    }
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
