// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/block_csr.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/wide.hpp"

namespace hilo {

void BlockCsr::structure(const Cliques& cliques, int n_blocks) {
  cliques_ = &cliques;
  std::vector<std::vector<int>> neighbours(n_blocks);
  for (int i = 0; i < n_blocks; ++i) neighbours[i].push_back(i);
  for (int e = 0; e < cliques.size(); ++e)
    for (int i : cliques[e])
      for (int j : cliques[e])
        if (i >= 0 && j >= 0) neighbours[i].push_back(j);
  block_start_.assign(1, 0);
  columns_.clear(), longest_ = 0;
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    columns_.insert(columns_.end(), list.begin(), list.end());
    block_start_.push_back(static_cast<int>(columns_.size()));
    longest_ = std::max(longest_, static_cast<int>(list.size()));
    std::vector<int>().swap(list);
  }
  row_start_.assign(1, 0);
  column_.clear();
  for (int i = 0; i < n_blocks; ++i)
    for (int r = 0; r < 3; ++r) {
      for (int k = block_start_[i]; k < block_start_[i + 1]; ++k)
        for (int c = 0; c < 3; ++c) column_.push_back(3 * columns_[k] + c);
      row_start_.push_back(static_cast<int>(column_.size()));
    }
  values_.assign(column_.size(), 0);
  position_.clear();
  clique_position_.assign(1, 0);
  for (int e = 0; e < cliques.size(); ++e) {
    for (int i : cliques[e])
      for (int j : cliques[e]) position_.push_back(i < 0 || j < 0 ? -1 : row_start_[3 * i] + 3 * place(i, j));
    clique_position_.push_back(position_.size());
  }
  diagonal_.resize(n_blocks);
  for (int i = 0; i < n_blocks; ++i) diagonal_[i] = row_start_[3 * i] + 3 * place(i, i);
}

int BlockCsr::place(int block, int column) const {
  const auto list = neighbours(block);
  return static_cast<int>(std::lower_bound(list.begin(), list.end(), column) - list.begin());
}

void BlockCsr::zero() { std::fill(values_.begin(), values_.end(), 0.0); }

void BlockCsr::add(int clique, const double* K) {
  const auto blocks = (*cliques_)[clique];
  const size_t n = blocks.size();
  const int* position = position_.data() + clique_position_[clique];
  // what the next clique adds to is fetched meanwhile; as a rule it is as large as this one
  const int* next = clique_position_[clique + 1] + n * n <= position_.size() ? position + n * n : position;
  for (size_t i = 0; i < n; ++i) {
    if (blocks[i] < 0) continue;
    const int length = 3 * (block_start_[blocks[i] + 1] - block_start_[blocks[i]]);
    for (size_t j = 0; j < n; ++j) {
      const int p = position[i * n + j];
      if (p < 0) continue;
      const double* soon = values_.data() + std::max(next[i * n + j], 0);
      for (int r = 0; r < 3; ++r) __builtin_prefetch(soon + r * length, 1);
      for (int r = 0; r < 3; ++r) {
        double* to = values_.data() + p + r * length;
        const double* from = K + (3 * i + r) * 3 * n + 3 * j;
        to[0] += from[0], to[1] += from[1], to[2] += from[2];
      }
    }
  }
}

void BlockCsr::add_part(int clique, int row, int column, int n, const double* K) {
  const auto blocks = (*cliques_)[clique];
  const int* position = position_.data() + clique_position_[clique] + static_cast<size_t>(row) * blocks.size() + column;
  for (int i = 0; i < n; ++i, position += blocks.size()) {
    if (blocks[row + i] < 0) continue;
    const int length = 3 * (block_start_[blocks[row + i] + 1] - block_start_[blocks[row + i]]);
    for (int j = 0; j < n; ++j) {
      if (position[j] < 0) continue;
      for (int r = 0; r < 3; ++r) {
        double* to = values_.data() + position[j] + r * length;
        const double* from = K + (3 * i + r) * 3 * n + 3 * j;
        to[0] += from[0], to[1] += from[1], to[2] += from[2];
      }
    }
  }
}

void BlockCsr::add_diagonal(int block, const double d[3]) {
  const int length = 3 * (block_start_[block + 1] - block_start_[block]);
  for (int r = 0; r < 3; ++r) values_[diagonal_[block] + r * length + r] += d[r];
}

/// Three rows at a time, as their columns are the same; `of_x`: room for these.
template <bool with_sums>
[[gnu::always_inline]] inline void multiply_rows(int n_blocks, const int* start, const int* columns, const double* a, const double* x,
                                                 double* of_x, double* y, double* sums) {
  typedef double V __attribute__((vector_size(64)));
  typedef long Bits __attribute__((vector_size(64)));
  constexpr int width = sizeof(V) / sizeof(double);
  const Bits no_sign = Bits{} + 0x7fffffffffffffff;
  const auto add = [](double value, double by, double& total, double& size) {
    const double term = value * by;
    total += term;
    if constexpr (with_sums) size += std::abs(term);
  };
  for (int i = 0; i < n_blocks; ++i) {
    const int first = start[i], last = start[i + 1], length = 3 * (last - first);
    if (length < 4 * width) {  // short rows cost more by lanes
      for (int row = 3 * i; row < 3 * i + 3; ++row) {
        double total = 0, size = 0;
        for (int k = first; k < last; ++k, a += 3)
          for (int c = 0; c < 3; ++c) add(a[c], x[3 * columns[k] + c], total, size);
        y[row] = total;
        if constexpr (with_sums) sums[row] = size;
      }
      continue;
    }
    for (int k = first; k < last; ++k)
      for (int c = 0; c < 3; ++c) of_x[3 * (k - first) + c] = x[3 * columns[k] + c];
    for (int row = 3 * i; row < 3 * i + 3; ++row, a += length) {
      V totals = {}, sizes = {}, values, by;
      int k = 0;
      for (; k + width <= length; k += width) {
        std::memcpy(&values, a + k, sizeof(V)), std::memcpy(&by, of_x + k, sizeof(V));
        const V terms = values * by;
        totals += terms;
        if constexpr (with_sums) sizes += (V)((Bits)terms & no_sign);
      }
      double total = 0, size = 0;
      for (; k < length; ++k) add(a[k], of_x[k], total, size);
      for (int l = 0; l < width; ++l) total += totals[l];
      for (int l = 0; with_sums && l < width; ++l) size += sizes[l];
      y[row] = total;
      if constexpr (with_sums) sums[row] = size;
    }
  }
}

HILO_WIDE static void multiply_wide(int n_blocks, const int* start, const int* columns, const double* a, const double* x, double* of_x,
                                    double* y) {
  multiply_rows<false>(n_blocks, start, columns, a, x, of_x, y, nullptr);
}
HILO_WIDE static void multiply_wide(int n_blocks, const int* start, const int* columns, const double* a, const double* x, double* of_x,
                                    double* y, double* sums) {
  multiply_rows<true>(n_blocks, start, columns, a, x, of_x, y, sums);
}

void BlockCsr::multiply(const double* x, double* y, double* sums) const {
  double few[96];
  std::vector<double> many(longest_ > 32 ? 3 * static_cast<size_t>(longest_) : 0);
  double* of_x = many.empty() ? few : many.data();
  if (sums)
    multiply_wide(n_blocks(), block_start_.data(), columns_.data(), values_.data(), x, of_x, y, sums);
  else
    multiply_wide(n_blocks(), block_start_.data(), columns_.data(), values_.data(), x, of_x, y);
}

}  // namespace hilo
