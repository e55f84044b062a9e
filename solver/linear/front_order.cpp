// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/front_order.hpp"

#include <suitesparse/cholmod.h>

#include <algorithm>
#include <new>

namespace hilo {

LowerBlocks::LowerBlocks(const Cliques& cliques, int n) : start(static_cast<size_t>(n) + 1, 0) {
  std::vector<std::int64_t> begin(static_cast<size_t>(n) + 1, 0);  // of the cliques of each block
  for (const int i : cliques.blocks)
    if (i >= 0) ++begin[i + 1];
  for (int i = 0; i < n; ++i) begin[i + 1] += begin[i];
  std::vector<int> of_block(static_cast<size_t>(begin[n])), seen(n, -1);
  auto at = begin;
  for (int e = 0; e < cliques.size(); ++e)
    for (const int i : cliques[e])
      if (i >= 0) of_block[at[i]++] = e;
  for (int c = 0; c < n; ++c) {
    rows.push_back(c), seen[c] = c;
    const auto own = rows.size();
    for (std::int64_t k = begin[c]; k < begin[c + 1]; ++k)
      for (const int i : cliques[of_block[k]])
        if (i > c && seen[i] != c) seen[i] = c, rows.push_back(i);
    std::sort(rows.begin() + static_cast<std::ptrdiff_t>(own), rows.end());
    start[c + 1] = static_cast<std::int64_t>(rows.size());
  }
}

FrontOrder::FrontOrder(const Cliques& cliques, int n_blocks) {
  LowerBlocks lower(cliques, n_blocks);
  std::vector<int> start(lower.start.begin(), lower.start.end());
  cholmod_common common{};
  cholmod_start(&common);
  common.print = 0, common.supernodal = CHOLMOD_SUPERNODAL, common.postorder = 1;
  common.nmethods = 1, common.method[0].ordering = CHOLMOD_GIVEN;
  common.nrelax[0] = 4, common.nrelax[1] = 11, common.nrelax[2] = 32;  // blocks of three: wide fronts, few calls
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = n_blocks;
  graph.nzmax = lower.rows.size();
  graph.p = start.data(), graph.i = lower.rows.data();
  graph.stype = -1, graph.itype = CHOLMOD_INT, graph.xtype = CHOLMOD_PATTERN, graph.dtype = CHOLMOD_DOUBLE;
  graph.packed = 1, graph.sorted = 1;
  std::vector<int> order(n_blocks);
  cholmod_factor* L =
      cholmod_metis(&graph, nullptr, 0, 1, order.data(), &common) ? cholmod_analyze_p(&graph, order.data(), nullptr, 0, &common) : nullptr;
  if (L && L->is_super) {
    place.resize(n_blocks);
    for (int k = 0; k < n_blocks; ++k) place[static_cast<const int*>(L->Perm)[k]] = k;
    const auto *super = static_cast<const int*>(L->super), *pi = static_cast<const int*>(L->pi), *s = static_cast<const int*>(L->s);
    first.assign(super, super + L->nsuper + 1), from.assign(pi, pi + L->nsuper + 1), rows.assign(s, s + L->ssize);
  }
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  if (place.empty()) throw std::bad_alloc();
  std::vector<int> front_of(n_blocks);
  parent.assign(first.size() - 1, -1);
  for (int f = 0; f < n_fronts(); ++f) std::fill(front_of.begin() + first[f], front_of.begin() + first[f + 1], f);
  for (int f = 0; f < n_fronts(); ++f) {
    if (height(f) > columns(f)) parent[f] = front_of[rows[from[f] + columns(f)]];
    entries += 9. * height(f) * columns(f), flops += flops_of(f);
  }
}

double FrontOrder::flops_of(int front) const {
  const double m = 3. * columns(front), below = 3. * height(front) - m;
  return m * m * m / 3 + m * m * below + m * below * below;
}

}  // namespace hilo
