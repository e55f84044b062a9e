// SPDX-License-Identifier: GPL-3.0-or-later
#include "part/partition.hpp"

#include <fmt/format.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>

#include "base/error.hpp"

namespace hilo {
namespace {

using Part = std::vector<std::int32_t>;

/// How far the heaviest part may be above the mean before a partition counts as unbalanced.
constexpr double tolerated = 1.05, tolerated_rigid = 1.5;

double largest_over_mean(const std::vector<std::int64_t>& work) {
  const auto sum = std::accumulate(work.begin(), work.end(), std::int64_t{0});
  return sum ? static_cast<double>(*std::max_element(work.begin(), work.end())) * static_cast<double>(work.size()) /
                   static_cast<double>(sum)
             : 1;
}

bool connected(const CellGraph& g) { return g.n() > 0 && pieces_of_parts(g, Part(g.flexible.size(), 0), 1)[0] == 1; }

/// One run of METIS; empty when it refuses.
Part metis(const CellGraph& g, int n_parts, bool weighted, bool contiguous, bool recursive) {
  std::vector<idx_t> weight;
  idx_t n = g.n(), constraints = 1, parts = n_parts, cut = 0;
  const bool some_flexible = std::ranges::count(g.is_flexible, 1) > 0, some_rigid = std::ranges::count(g.is_flexible, 0) > 0;
  if (weighted) {  // a constraint without any work would put everything in one part
    constraints = some_flexible && some_rigid ? 2 : 1;
    for (idx_t c = 0; c < n; ++c) {
      if (some_flexible) weight.push_back(g.flexible[c]);
      if (some_rigid) weight.push_back(g.rigid[c]);
    }
  }
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;  // the same for the same input
  options[METIS_OPTION_NUMBERING] = 0;
  if (!recursive) options[METIS_OPTION_CONTIG] = contiguous;
  std::vector<real_t> slack{real_t(some_flexible || !weighted ? 1.03 : 1.10)};
  if (constraints == 2) slack.push_back(real_t(1.20));
  auto first = g.first, next = g.next, joined = g.joined;  // METIS wants them writable
  Part part(g.flexible.size());
  const auto run = recursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int code = run(&n, &constraints, first.data(), next.data(), weighted ? weight.data() : nullptr, nullptr, joined.data(), &parts,
                       nullptr, slack.data(), options, &cut, part.data());
  if (code != METIS_OK) return {};
  return part;
}

/// Slices across the longest side of the mesh with equal work: no part is empty.  Flexible and rigid cells are sliced separately.
Part slices(const CellGraph& g, const Mesh& mesh, int n_parts, bool weighted) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const auto& x : mesh.X) low = low.cwiseMin(x), high = high.cwiseMax(x);
  Eigen::Index axis;
  (high - low).maxCoeff(&axis);
  std::vector<double> centre(g.flexible.size(), 0);
  for (std::int32_t c = 0; c < g.n(); ++c)
    for (const auto n : mesh.cell(c)) centre[c] += mesh.X[n][axis] / static_cast<double>(mesh.cell(c).size());
  Part part(g.flexible.size(), 0);
  const auto slice = [&](const auto& takes, const auto& work) {
    std::vector<std::int32_t> cells;
    std::int64_t total = 0, done = 0;
    for (std::int32_t c = 0; c < g.n(); ++c)
      if (takes(c)) cells.push_back(c), total += work(c);
    std::stable_sort(cells.begin(), cells.end(), [&](auto a, auto b) { return centre[a] < centre[b]; });
    const auto count = static_cast<std::int64_t>(cells.size());
    int p = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      const bool full = done * n_parts >= total * (p + 1), must = count - i <= n_parts - 1 - p;  // leave a cell for each part to come
      if (i > 0 && p + 1 < n_parts && (full || must)) ++p;
      part[cells[i]] = p;
      done += work(cells[i]);
    }
  };
  if (weighted) {
    slice([&](auto c) { return g.is_flexible[c] != 0; }, [&](auto c) { return g.flexible[c]; });
    slice([&](auto c) { return g.is_flexible[c] == 0; }, [&](auto c) { return g.rigid[c]; });
  } else {
    slice([](auto) { return true; }, [](auto) { return 1; });
  }
  return part;
}

/// Give small pieces that lie apart from the rest of their part to the neighbour that most joins them, where its work allows.
void join_pieces(const CellGraph& g, Part& part, int n_parts) {
  PartReport r = report(g, part, n_parts);
  const auto mean = [&](const std::vector<std::int64_t>& work) {
    return static_cast<double>(std::accumulate(work.begin(), work.end(), std::int64_t{0})) / n_parts;
  };
  const double most_flexible = tolerated * mean(r.flexible_work), most_rigid = tolerated_rigid * mean(r.rigid_work);
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<std::vector<std::int32_t>> pieces;  // of all parts
    std::vector<std::array<std::int64_t, 2>> work;
    std::vector<char> seen(part.size(), 0);
    for (std::int32_t start = 0; start < g.n(); ++start) {
      if (seen[start]) continue;
      auto& piece = pieces.emplace_back(1, start);
      auto& sum = work.emplace_back(std::array<std::int64_t, 2>{0, 0});
      seen[start] = 1;
      for (size_t i = 0; i < piece.size(); ++i) {
        const auto c = piece[i];
        sum[0] += g.flexible[c], sum[1] += g.rigid[c];
        for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
          if (const auto b = g.next[k]; !seen[b] && part[b] == part[c]) seen[b] = 1, piece.push_back(b);
      }
    }
    std::vector<size_t> main(n_parts, pieces.size());  // the largest piece of each part stays
    for (size_t i = 0; i < pieces.size(); ++i) {
      auto& best = main[part[pieces[i][0]]];
      if (best == pieces.size() || work[i] > work[best]) best = i;
    }
    bool moved = false;
    for (size_t i = 0; i < pieces.size(); ++i) {
      const auto from = part[pieces[i][0]];
      if (main[from] == i) continue;
      std::map<std::int32_t, std::int64_t> joined;  // weight of the edges to each other part
      for (const auto c : pieces[i])
        for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
          if (part[g.next[k]] != from) joined[part[g.next[k]]] += g.joined[k];
      std::int32_t to = -1;
      for (const auto& [p, weight] : joined)
        if ((to < 0 || weight > joined[to]) && (work[i][0] == 0 || static_cast<double>(r.flexible_work[p] + work[i][0]) <= most_flexible) &&
            (work[i][1] == 0 || static_cast<double>(r.rigid_work[p] + work[i][1]) <= most_rigid))
          to = p;
      if (to < 0) continue;
      for (const auto c : pieces[i]) part[c] = to;
      r.flexible_work[from] -= work[i][0], r.rigid_work[from] -= work[i][1];
      r.flexible_work[to] += work[i][0], r.rigid_work[to] += work[i][1];
      moved = true;
    }
    if (!moved) break;
  }
}

/// Order of merit, smaller is better.
auto merit(const CellGraph& g, const Part& part, int n_parts, bool weighted) {
  const PartReport r = report(g, part, n_parts);
  const auto empty =
      std::ranges::count(r.cells, 0) + (weighted && std::ranges::count(g.is_flexible, 1) ? std::ranges::count(r.flexible_cells, 0) : 0);
  const double off = weighted ? std::max(0., r.flexible_balance - tolerated) + 0.2 * std::max(0., r.rigid_balance - tolerated_rigid)
                              : std::max(0., largest_over_mean(r.cells) - tolerated);
  return std::tuple(empty, off, std::accumulate(r.pieces.begin(), r.pieces.end(), 0), r.flexible_cut, r.cut);
}

}  // namespace

PartReport report(const CellGraph& g, const Part& part, int n_parts) {
  PartReport r;
  for (auto* list : {&r.cells, &r.flexible_cells, &r.flexible_work, &r.rigid_work}) list->assign(n_parts, 0);
  for (std::int32_t c = 0; c < g.n(); ++c) {
    const auto p = part[c];
    ++r.cells[p], r.flexible_cells[p] += g.is_flexible[c], r.flexible_work[p] += g.flexible[c], r.rigid_work[p] += g.rigid[c];
    for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
      if (const auto b = g.next[k]; b > c && part[b] != p) ++r.cut, r.flexible_cut += g.is_flexible[c] && g.is_flexible[b];
  }
  r.pieces = pieces_of_parts(g, part, n_parts);
  r.flexible_pieces = pieces_of_parts(g, part, n_parts, true);
  r.flexible_balance = largest_over_mean(r.flexible_work);
  r.rigid_balance = largest_over_mean(r.rigid_work);
  std::vector<std::int64_t> work = r.flexible_work;
  for (int p = 0; p < n_parts; ++p) work[p] += r.rigid_work[p];
  r.speed_up = n_parts / largest_over_mean(work);
  return r;
}

Part partition(const CellGraph& g, const Mesh& mesh, int n_parts, bool weighted) {
  const auto flexible = std::ranges::count(g.is_flexible, 1);
  if (n_parts > g.n()) throw Error("", fmt::format("{} parts of {} cells", n_parts, g.n()), fmt::format("at most {}", g.n()));
  if (weighted && flexible > 0 && n_parts > flexible)
    throw Error("", fmt::format("{} parts of {} flexible cells would leave parts without work", n_parts, flexible),
                fmt::format("at most {}", flexible));
  if (n_parts == 1) return Part(g.flexible.size(), 0);  // METIS divides by zero
  Part best;
  const auto consider = [&](Part part) {
    if (part.empty()) return;
    if (weighted) join_pieces(g, part, n_parts);
    if (best.empty() || merit(g, part, n_parts, weighted) < merit(g, best, n_parts, weighted)) best = std::move(part);
  };
  const auto good = [&] {
    if (best.empty()) return false;
    const auto m = merit(g, best, n_parts, weighted);
    return std::get<0>(m) == 0 && std::get<1>(m) == 0;
  };
  if (connected(g)) consider(metis(g, n_parts, weighted, true, false));
  if (!good()) consider(metis(g, n_parts, weighted, false, false));
  if (!good()) consider(metis(g, n_parts, weighted, false, true));
  if (!good()) consider(slices(g, mesh, n_parts, weighted));
  return best;
}

}  // namespace hilo
