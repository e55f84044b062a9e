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
constexpr double tolerated = 1.05, tolerated_other = 1.5;

double largest_over_mean(const std::vector<std::int64_t>& work) {
  const auto sum = std::accumulate(work.begin(), work.end(), std::int64_t{0});
  return sum ? static_cast<double>(*std::max_element(work.begin(), work.end())) * static_cast<double>(work.size()) /
                   static_cast<double>(sum)
             : 1;
}

bool connected(const CellGraph& g) { return g.n() > 0 && pieces_of_parts(g, Part(g.nonlinear.size(), 0), 1)[0] == 1; }

/// One run of METIS; empty when it refuses.
Part metis(const CellGraph& g, int n_parts, bool weighted, bool contiguous, bool recursive) {
  std::vector<idx_t> weight;
  idx_t n = g.n(), constraints = 1, parts = n_parts, cut = 0;
  const bool some_nonlinear = std::ranges::count(g.is_nonlinear, 1) > 0, some_other = std::ranges::count(g.is_nonlinear, 0) > 0;
  if (weighted) {  // a constraint without any work would put everything in one part
    constraints = some_nonlinear && some_other ? 2 : 1;
    for (idx_t c = 0; c < n; ++c) {
      if (some_nonlinear) weight.push_back(g.nonlinear[c]);
      if (some_other) weight.push_back(g.other[c]);
    }
  }
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;  // the same for the same input
  options[METIS_OPTION_NUMBERING] = 0;
  if (!recursive) options[METIS_OPTION_CONTIG] = contiguous;
  std::vector<real_t> slack{real_t(some_nonlinear || !weighted ? 1.03 : 1.10)};
  if (constraints == 2) slack.push_back(real_t(1.20));
  auto first = g.first, next = g.next, joined = g.joined;  // METIS wants them writable
  Part part(g.nonlinear.size());
  const auto run = recursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int code = run(&n, &constraints, first.data(), next.data(), weighted ? weight.data() : nullptr, nullptr, joined.data(), &parts,
                       nullptr, slack.data(), options, &cut, part.data());
  if (code != METIS_OK) return {};
  return part;
}

/// Slices across the longest side of the mesh with equal work: no part is empty.  Nonlinear and other cells are sliced separately.
Part slices(const CellGraph& g, const Mesh& mesh, int n_parts, bool weighted) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const auto& x : mesh.X) low = low.cwiseMin(x), high = high.cwiseMax(x);
  Eigen::Index axis;
  (high - low).maxCoeff(&axis);
  std::vector<double> centre(g.nonlinear.size(), 0);
  for (std::int32_t c = 0; c < g.n(); ++c)
    for (const auto n : mesh.cell(c)) centre[c] += mesh.X[n][axis] / static_cast<double>(mesh.cell(c).size());
  Part part(g.nonlinear.size(), 0);
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
    slice([&](auto c) { return g.is_nonlinear[c] != 0; }, [&](auto c) { return g.nonlinear[c]; });
    slice([&](auto c) { return g.is_nonlinear[c] == 0; }, [&](auto c) { return g.other[c]; });
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
  const double most_nonlinear = tolerated * mean(r.nonlinear_work), most_other = tolerated_other * mean(r.other_work);
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
        sum[0] += g.nonlinear[c], sum[1] += g.other[c];
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
        if ((to < 0 || weight > joined[to]) &&
            (work[i][0] == 0 || static_cast<double>(r.nonlinear_work[p] + work[i][0]) <= most_nonlinear) &&
            (work[i][1] == 0 || static_cast<double>(r.other_work[p] + work[i][1]) <= most_other))
          to = p;
      if (to < 0) continue;
      for (const auto c : pieces[i]) part[c] = to;
      r.nonlinear_work[from] -= work[i][0], r.other_work[from] -= work[i][1];
      r.nonlinear_work[to] += work[i][0], r.other_work[to] += work[i][1];
      moved = true;
    }
    if (!moved) break;
  }
}

/// Order of merit, smaller is better.
auto merit(const CellGraph& g, const Part& part, int n_parts, bool weighted) {
  const PartReport r = report(g, part, n_parts);
  const auto empty =
      std::ranges::count(r.cells, 0) + (weighted && std::ranges::count(g.is_nonlinear, 1) ? std::ranges::count(r.nonlinear_cells, 0) : 0);
  const double off = weighted ? std::max(0., r.nonlinear_balance - tolerated) + 0.2 * std::max(0., r.other_balance - tolerated_other)
                              : std::max(0., largest_over_mean(r.cells) - tolerated);
  return std::tuple(empty, off, std::accumulate(r.pieces.begin(), r.pieces.end(), 0), r.nonlinear_cut, r.cut);
}

}  // namespace

PartReport report(const CellGraph& g, const Part& part, int n_parts) {
  PartReport r;
  for (auto* list : {&r.cells, &r.nonlinear_cells, &r.nonlinear_work, &r.other_work}) list->assign(n_parts, 0);
  for (std::int32_t c = 0; c < g.n(); ++c) {
    const auto p = part[c];
    ++r.cells[p], r.nonlinear_cells[p] += g.is_nonlinear[c], r.nonlinear_work[p] += g.nonlinear[c], r.other_work[p] += g.other[c];
    for (auto k = g.first[c]; k < g.first[c + 1]; ++k)
      if (const auto b = g.next[k]; b > c && part[b] != p) ++r.cut, r.nonlinear_cut += g.is_nonlinear[c] && g.is_nonlinear[b];
  }
  r.pieces = pieces_of_parts(g, part, n_parts);
  r.nonlinear_pieces = pieces_of_parts(g, part, n_parts, true);
  r.nonlinear_balance = largest_over_mean(r.nonlinear_work);
  r.other_balance = largest_over_mean(r.other_work);
  std::vector<std::int64_t> work = r.nonlinear_work;
  for (int p = 0; p < n_parts; ++p) work[p] += r.other_work[p];
  r.speed_up = n_parts / largest_over_mean(work);
  return r;
}

Part partition(const CellGraph& g, const Mesh& mesh, int n_parts, bool weighted) {
  const auto nonlinear = std::ranges::count(g.is_nonlinear, 1);
  if (n_parts > g.n()) throw Error("", fmt::format("{} parts of {} cells", n_parts, g.n()), fmt::format("at most {}", g.n()));
  if (weighted && nonlinear > 0 && n_parts > nonlinear)
    throw Error("", fmt::format("{} parts of {} nonlinear cells would leave parts without work", n_parts, nonlinear),
                fmt::format("at most {}", nonlinear));
  if (n_parts == 1) return Part(g.nonlinear.size(), 0);  // METIS divides by zero
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
